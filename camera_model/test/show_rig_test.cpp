// The tool as a user calls it.

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <sys/wait.h>

#include "camera_model/rig.h"
#include "rig_files.h"

namespace vins::camera_model {
namespace {

class ShowRig : public RigFiles {
 protected:
  /// Exit code; what it prints goes to out.txt and err.txt.
  int run(const std::string& arguments) const {
    const auto tool = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "show_rig";
    const std::string command = tool.string() + " " + arguments + " > " +
                                (folder_ / "out.txt").string() + " 2> " +
                                (folder_ / "err.txt").string();
    return WEXITSTATUS(std::system(command.c_str()));
  }

  std::string contentOf(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(ShowRig, PrintsAConfigurationAndTellsWhatWasMended) {
  ASSERT_EQ(run(write("rig.yaml", rig_files::vinsMono() + "max_cnt:150\nmy_key: 1\n")), 0);
  const Rig rig = readRig(Parameters::parse(contentOf("out.txt"), "out.txt"));
  EXPECT_EQ(rig.imu.topic, "/imu0");
  EXPECT_NE(contentOf("err.txt").find("mended as OpenCV reads it"), std::string::npos);
  EXPECT_NE(contentOf("err.txt").find("unknown key 'my_key'"), std::string::npos);
  EXPECT_NE(contentOf("err.txt").find("deviations of one sample at 200 Hz"), std::string::npos);
}

TEST_F(ShowRig, WritesWhatItReads) {
  write("cam0.yaml", rig_files::camera());
  write("cam1.yaml", rig_files::camera(470.0));
  const std::string written = (folder_ / "written.yaml").string();
  ASSERT_EQ(run(write("rig.yaml", rig_files::vinsFusion(2)) + " --write " + written), 0);
  const Rig rig = readRigFile(written);
  ASSERT_EQ(rig.cameras.size(), 2u);
  EXPECT_EQ(rig.cameras[1].camera->parameters()[0], 470.0);
  EXPECT_EQ(rig.cameras[1].image_topic, "/right/image_raw");
}

TEST_F(ShowRig, EndsWithAnErrorThatNamesTheKey) {
  EXPECT_EQ(run(write("rig.yaml", rig_files::vinsMono() + "imu: 0\n")), 1);
  EXPECT_NE(contentOf("err.txt").find("key 'imu'"), std::string::npos) << contentOf("err.txt");
  EXPECT_EQ(run(""), 1);
}

}  // namespace
}  // namespace vins::camera_model
