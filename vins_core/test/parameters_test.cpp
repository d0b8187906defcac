#include "vins_core/parameters.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins {
namespace {

/// In the form of VINS-Mono's configuration files: OpenCV's directive, no document start.
constexpr char kRig[] = R"(%YAML:1.0

#common parameters
imu_topic: "/imu0"
max_cnt: 150            # features
freq: 10
acc_n: 0.08          # noise. #0.2
equalize: 1
mode: Fast
extrinsicRotation: !!opencv-matrix
   rows: 2
   cols: 3
   dt: d
   data: [1.0, -2.0, 3.0,
          4e-1, 5.0, 6.0]
rows_of_rows:
- [1, 2]
- [3, 4]
coefficients: [0.1, 0.2, 0.3, 0.4]
camera:
   width: 752
   hieght: 480
)";

/// Message of the InputError that `call` throws, or "" where it throws none.
template <typename Call>
std::string errorOf(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

class ParametersTest : public ::testing::Test {
 protected:
  Parameters rig_ = Parameters::parse(kRig, "rig.yaml");
};

TEST_F(ParametersTest, ReadsOpencvForm) {
  EXPECT_EQ(rig_.text("imu_topic"), "/imu0");
  EXPECT_EQ(rig_.integer("max_cnt", {1, 1000}), 150);
  EXPECT_DOUBLE_EQ(rig_.number("acc_n"), 0.08);
  EXPECT_TRUE(rig_.flag("equalize"));
  EXPECT_EQ(rig_.text("mode", {"slow", "fast"}), "fast");
  const Eigen::MatrixXd R = rig_.matrix("extrinsicRotation", 2, 3);
  EXPECT_EQ(R, (Eigen::MatrixXd(2, 3) << 1.0, -2.0, 3.0, 0.4, 5.0, 6.0).finished());
  EXPECT_EQ(rig_.matrix("rows_of_rows", 2, 2), (Eigen::MatrixXd(2, 2) << 1, 2, 3, 4).finished());
  EXPECT_EQ(rig_.numbers("coefficients", {4, 5}).size(), 4u);
  EXPECT_EQ(rig_.section("camera").integer("width"), 752);
}

TEST_F(ParametersTest, AbsentKeysTakeTheFallbackAndPresentOnesAreStillChecked) {
  EXPECT_EQ(rig_.integerOr("min_dist", 30), 30);
  EXPECT_DOUBLE_EQ(rig_.numberOr("td", -0.5), -0.5);
  EXPECT_EQ(rig_.textOr("output_path", "here"), "here");
  EXPECT_FALSE(rig_.flagOr("fisheye", false));
  EXPECT_EQ(errorOf([&] {
              rig_.integerOr("max_cnt", 3, {1, 100});
            }),
            "rig.yaml:5: key 'max_cnt': found '150'; allowed: a whole number from 1 to 100");
}

TEST_F(ParametersTest, ErrorsNameFileLineKeyFoundAndAllowed) {
  EXPECT_EQ(errorOf([&] { rig_.number("imu_topic", {0.0}); }),
            "rig.yaml:4: key 'imu_topic': found '/imu0'; allowed: a number, at least 0");
  EXPECT_EQ(errorOf([&] { rig_.integer("acc_n"); }),
            "rig.yaml:7: key 'acc_n': found '0.08'; allowed: a whole number");
  EXPECT_EQ(errorOf([&] {
              rig_.text("mode", {"slow", "exact"});
            }),
            "rig.yaml:9: key 'mode': found 'Fast'; allowed: slow, exact");
  EXPECT_EQ(errorOf([&] { rig_.flag("max_cnt"); }),
            "rig.yaml:5: key 'max_cnt': found '150'; allowed: 0 or 1");
  EXPECT_EQ(errorOf([&] { rig_.matrix("extrinsicRotation", 3, 3); }),
            "rig.yaml:10: key 'extrinsicRotation': found a section; allowed: a matrix of 3 x 3 "
            "finite numbers");
  EXPECT_EQ(errorOf([&] { rig_.numbers("coefficients", {5}); }),
            "rig.yaml:19: key 'coefficients': found a sequence of 4; allowed: a sequence of 5 "
            "finite numbers");
  EXPECT_EQ(errorOf([&] { rig_.section("freq"); }),
            "rig.yaml:6: key 'freq': found '10'; allowed: a section of lines 'key: value'");
}

TEST_F(ParametersTest, MissingKeysNameTheSlipThatLooksLikeThem) {
  EXPECT_EQ(errorOf([&] { rig_.section("camera").integer("height", {1}); }),
            "rig.yaml: camera: key 'height' is missing; allowed: a whole number, at least 1; "
            "line 22 has 'hieght': is that meant?");
  EXPECT_EQ(errorOf([&] { rig_.text("zzz"); }), "rig.yaml: key 'zzz' is missing; allowed: text");
}

TEST_F(ParametersTest, WarningsNameKeysThatNobodyAskedFor) {
  const Parameters rig = Parameters::parse("max_cn: 3\nimage_topic: /a\nwhatever: 1\n", "r.yaml");
  rig.integerOr("max_cnt", 150);
  rig.text("image_topic");
  const std::vector<std::string> warnings = rig.warnings();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0], "r.yaml:1: unknown key 'max_cn' is ignored; did you mean 'max_cnt'?");
  EXPECT_EQ(warnings[1], "r.yaml:3: unknown key 'whatever' is ignored");
}

TEST_F(ParametersTest, WarningsLeaveOutKeysThatOthersRead) {
  const Parameters rig = Parameters::parse("freq: 10\nwindow: {a: 1}\nfrek: 1\n", "r.yaml");
  rig.know({"freq", "window", "is_not_in_the_file"});
  EXPECT_EQ(rig.warnings(), std::vector<std::string>(
                                {"r.yaml:3: unknown key 'frek' is ignored; did you mean 'freq'?"}));
}

TEST(Parameters, RefusesWhatIsNoMap) {
  EXPECT_EQ(errorOf([] { Parameters::parse("", "f"); }),
            "f: found nothing; allowed: lines of the form 'key: value'");
  EXPECT_EQ(errorOf([] { Parameters::parse("- 1\n- 2\n", "f"); }),
            "f: found a sequence of 2; allowed: lines of the form 'key: value'");
  const std::string error = errorOf([] { Parameters::parse("a: 1\nb: [1, 2\nc: 3\n", "f"); });
  EXPECT_EQ(error.rfind("f:3: not valid YAML at column", 0), 0u) << error;
}

TEST(Parameters, RefusesNumbersThatAreNotFinite) {
  for (const char* value : {".nan", "nan", "inf", "1e999", "1.0.0", "''", "0x"}) {
    const Parameters p = Parameters::parse(std::string("a: ") + value, "f");
    EXPECT_NE(errorOf([&] { p.number("a"); }), "") << value;
  }
}

/// Values as cv::FileStorage (4.6) gives them for the same text.
TEST(Parameters, ReadsWhatOpencvReadsAndYamlDoesNot) {
  const Parameters p = Parameters::parse(
      "%YAML:1.0\n\nmax_cnt:150\nacc_n: 0.08# noise\ntopic:\"/a#b\"# c:d\npath: a#b\n"
      "distortion: {k1:-0.28,k2: 0.07, k3:1.}\nfreq: 10\nlist: [1,\n  2]# end\nfreq: 20\n"
      "window:\n   a:1\n   a: 2\n",
      "rig.yaml");
  EXPECT_EQ(p.integer("max_cnt"), 150);
  EXPECT_EQ(p.number("acc_n"), 0.08);
  EXPECT_EQ(p.text("topic"), "/a#b");
  EXPECT_EQ(p.text("path"), "a#b");
  EXPECT_EQ(p.section("distortion").number("k1"), -0.28);
  EXPECT_EQ(p.section("distortion").number("k3"), 1.0);
  EXPECT_EQ(p.numbers("list", {2}), (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(p.integer("freq"), 10) << "of a key that is given twice the first counts";
  EXPECT_EQ(p.section("window").integer("a"), 1);
  ASSERT_EQ(p.remarks().size(), 1u) << "all in one line";
  const std::string remark = p.remarks()[0];
  EXPECT_EQ(
      remark.rfind("rig.yaml: mended as OpenCV reads it: line 3: 'max_cnt:' has no space after "
                   "the colon; line 4: '0.08#' has no space before the comment; ",
                   0),
      0u)
      << remark;
  EXPECT_NE(remark.find("line 11: 'freq' is given again; the value of line 8 counts"),
            std::string::npos)
      << remark;
}

TEST(Parameters, LeavesProperYamlAsItIs) {
  const Parameters p = Parameters::parse(
      "url: http://host:80/a\nquoted: 'a:b # c'\nescaped: \"a\\\"#:b\"\nlist: ['a:b', \"c#d\"]\n"
      "rows:\n- [1, 2]\n- [3, 4]\n- key: 1\n",
      "f");
  EXPECT_EQ(p.text("url"), "http://host:80/a");
  EXPECT_EQ(p.text("quoted"), "a:b # c");
  EXPECT_EQ(p.text("escaped"), "a\"#:b");
  EXPECT_TRUE(p.remarks().empty()) << p.remarks().front();
}

TEST(Parameters, AKeyWithoutAValueIsAbsent) {
  const Parameters p = Parameters::parse("mask:\nfreq:\nwidth:\n", "f");
  EXPECT_FALSE(p.has("mask"));
  EXPECT_EQ(p.textOr("mask", "none"), "none");
  EXPECT_EQ(p.integerOr("freq", 7), 7);
  EXPECT_EQ(errorOf([&] { p.integer("width"); }),
            "f:3: key 'width': found nothing; allowed: a whole number");
  EXPECT_EQ(p.warnings(), std::vector<std::string>()) << "known nevertheless";
}

TEST(Parameters, TakesNumbersInAnyForm) {
  const Parameters p = Parameters::parse(
      "a: 1.\nb: .5\nc: +1\nd: -.5e-3\ne: 1.e3\nf: 0x10\ng: 150.0\nh: 1.0\n", "f");
  EXPECT_EQ(p.number("a"), 1.0);
  EXPECT_EQ(p.number("b"), 0.5);
  EXPECT_EQ(p.number("c"), 1.0);
  EXPECT_EQ(p.number("d"), -0.5e-3);
  EXPECT_EQ(p.number("e"), 1000.0);
  EXPECT_EQ(p.integer("f"), 16);
  EXPECT_EQ(p.integer("g"), 150);
  EXPECT_TRUE(p.flag("h"));
}

TEST(Parameters, RemarksOfSectionsComeWithTheFiles) {
  const Parameters p = Parameters::parse("a: 1\ns:\n  b: 2\n", "f");
  p.section("s").remark("b", "b is changed");
  p.remark("c", "c is chosen");
  EXPECT_EQ(p.remarks(), (std::vector<std::string>{"f:3: b is changed", "f: c is chosen"}));
}

TEST(Parameters, MissingFileIsNamed) {
  EXPECT_EQ(errorOf([] { Parameters::load("/nowhere/rig.yaml"); }),
            "/nowhere/rig.yaml: cannot be opened for reading");
}

TEST(Parameters, LoadReadsAFile) {
  const std::string path = ::testing::TempDir() + "parameters_test.yaml";
  std::ofstream(path) << kRig;
  EXPECT_EQ(Parameters::load(path).integer("freq"), 10);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace vins
