#include "camera_model/camera_file.h"

#include <cstdio>
#include <sstream>
#include <utility>
#include <vector>

#include "camera_model/kannala_brandt.h"
#include "camera_model/mei.h"
#include "camera_model/pinhole_radtan.h"
#include "camera_model/scaramuzza.h"
#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

constexpr int kInversePolynomialCount = 20;   ///< coefficients that camodocal's reader expects
constexpr int kInversePolynomialFitted = 14;  ///< of them not zero: more only fit rounding

using Names = std::vector<std::string>;

/// Numbers of the section's keys, appended to `values`.
void append(const Parameters& section, const Names& keys, std::vector<double>* values) {
  for (const std::string& key : keys) values->push_back(section.number(key));
}

CameraParameters toParameters(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<int>(values.size()));
}

std::unique_ptr<Camera> makeCamera(CameraModel model, const std::string& name, ImageSize size,
                                   const CameraParameters& p) {
  switch (model) {
    case CameraModel::kPinhole:
      return std::make_unique<PinholeRadtan>(name, size, p);
    case CameraModel::kKannalaBrandt:
      return std::make_unique<KannalaBrandt>(name, size, p);
    case CameraModel::kMei:
      return std::make_unique<Mei>(name, size, p);
    case CameraModel::kScaramuzza:
      return std::make_unique<Scaramuzza>(name, size, p);
  }
  return nullptr;
}

std::vector<double> readPinhole(const Parameters& file) {
  std::vector<double> values;
  append(file.section("projection_parameters"), {"fx", "fy", "cx", "cy"}, &values);
  const Parameters distortion = file.section("distortion_parameters");
  append(distortion, {"k1", "k2", "p1", "p2"}, &values);
  values.push_back(distortion.numberOr("k3", 0.0));
  return values;
}

std::vector<double> readMei(const Parameters& file) {
  std::vector<double> values;
  append(file.section("mirror_parameters"), {"xi"}, &values);
  append(file.section("distortion_parameters"), {"k1", "k2", "p1", "p2"}, &values);
  append(file.section("projection_parameters"), {"gamma1", "gamma2", "u0", "v0"}, &values);
  return values;
}

std::vector<double> readScaramuzza(const Parameters& file) {
  std::vector<double> values;
  append(file.section("poly_parameters"), {"p0", "p1", "p2", "p3", "p4"}, &values);
  append(file.section("affine_parameters"), {"ac", "ad", "ae", "cx", "cy"}, &values);
  // The inverse polynomial follows from the other; asking for it keeps it from being "unknown".
  if (file.has("inv_poly_parameters")) file.section("inv_poly_parameters");
  return values;
}

std::vector<double> readValues(CameraModel model, const Parameters& file) {
  std::vector<double> values;
  switch (model) {
    case CameraModel::kPinhole:
      return readPinhole(file);
    case CameraModel::kKannalaBrandt:
      append(file.section("projection_parameters"),
             {"k2", "k3", "k4", "k5", "mu", "mv", "u0", "v0"}, &values);
      return values;
    case CameraModel::kMei:
      return readMei(file);
    case CameraModel::kScaramuzza:
      return readScaramuzza(file);
  }
  return values;
}

/// InputErrors of a camera's constructor know no file: puts its name before them.
template <typename Make>
std::unique_ptr<Camera> namingFile(const Parameters& file, Make make) {
  try {
    return make();
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.rfind(file.name(), 0) == 0) throw;
    throw InputError(file.name() + ": " + message);
  }
}

std::unique_ptr<Camera> readCamodocal(const Parameters& file) {
  const CameraModel model = cameraModelFromString(
      file.text("model_type", {"PINHOLE", "KANNALA_BRANDT", "MEI", "SCARAMUZZA"}));
  const std::string name = file.textOr("camera_name", "camera");
  const ImageSize size{file.integer("image_width", {1, 100000}),
                       file.integer("image_height", {1, 100000})};
  const CameraParameters parameters = toParameters(readValues(model, file));
  return namingFile(file, [&] { return makeCamera(model, name, size, parameters); });
}

std::unique_ptr<Camera> readKalibr(const Parameters& file, const std::string& name) {
  const Parameters section = file.section(name);
  const std::string projection = section.text("camera_model", {"pinhole", "omni"});
  const bool is_omni = projection == "omni";
  const std::string distortion =
      section.text("distortion_model",
                   is_omni ? Names{"radtan", "none"} : Names{"radtan", "equidistant", "none"});
  const std::vector<double> f = section.numbers("intrinsics", {is_omni ? 5u : 4u});
  const std::vector<double> k = distortion == "none" ? std::vector<double>(4, 0.0)
                                                     : section.numbers("distortion_coeffs", {4});
  const std::vector<double> resolution = section.numbers("resolution", {2});
  const ImageSize size{static_cast<int>(resolution[0]), static_cast<int>(resolution[1])};
  return namingFile(file, [&]() -> std::unique_ptr<Camera> {
    if (is_omni) {
      return makeCamera(CameraModel::kMei, name, size,
                        toParameters({f[0], k[0], k[1], k[2], k[3], f[1], f[2], f[3], f[4]}));
    }
    if (distortion == "equidistant") {
      return makeCamera(CameraModel::kKannalaBrandt, name, size,
                        toParameters({k[0], k[1], k[2], k[3], f[0], f[1], f[2], f[3]}));
    }
    return makeCamera(CameraModel::kPinhole, name, size,
                      toParameters({f[0], f[1], f[2], f[3], k[0], k[1], k[2], k[3], 0.0}));
  });
}

/// The shortest decimal that reads back as the same double.
std::string exactText(double value) {
  char text[32];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof(text), "%.*g", digits, value);
    if (std::stod(text) == value) break;
  }
  // A whole number would be read as an integer by OpenCV's storage.
  const std::string plain = text;
  return plain.find_first_of(".en") == std::string::npos ? plain + ".0" : plain;
}

std::string sectionText(const std::string& title, const Names& keys,
                        const std::vector<double>& values) {
  std::string text = title + ":\n";
  for (std::size_t i = 0; i < keys.size(); ++i) {
    text += "   " + keys[i] + ": " + exactText(values[i]) + "\n";
  }
  return text;
}

/// Section `title` of the parameters `first` to `first + count - 1`.
std::string sectionText(const std::string& title, const Camera& camera, int first, int count) {
  const Names names = camera.parameterNames();
  const CameraParameters p = camera.parameters();
  return sectionText(title, Names(names.begin() + first, names.begin() + first + count),
                     std::vector<double>(p.data() + first, p.data() + first + count));
}

std::string inversePolynomialText(const Scaramuzza& camera) {
  std::vector<double> values = camera.fitInversePolynomial(kInversePolynomialFitted);
  values.resize(kInversePolynomialCount, 0.0);
  Names names;
  for (int i = 0; i < kInversePolynomialCount; ++i) names.push_back("p" + std::to_string(i));
  return sectionText("inv_poly_parameters", names, values);
}

std::string parametersText(const Camera& camera) {
  switch (camera.model()) {
    case CameraModel::kPinhole:
      return sectionText("distortion_parameters", camera, 4,
                         camera.parameters()[8] == 0.0 ? 4 : 5) +
             sectionText("projection_parameters", camera, 0, 4);
    case CameraModel::kKannalaBrandt:
      return sectionText("projection_parameters", camera, 0, 8);
    case CameraModel::kMei:
      return sectionText("mirror_parameters", camera, 0, 1) +
             sectionText("distortion_parameters", camera, 1, 4) +
             sectionText("projection_parameters", camera, 5, 4);
    case CameraModel::kScaramuzza:
      return sectionText("poly_parameters", camera, 0, 5) +
             inversePolynomialText(static_cast<const Scaramuzza&>(camera)) +
             sectionText("affine_parameters", camera, 5, 5);
  }
  return "";
}

std::string listText(const CameraParameters& p, const std::vector<int>& order) {
  std::string text;
  for (const int i : order) text += (text.empty() ? "[" : ", ") + exactText(p[i]);
  return text + "]";
}

}  // namespace

std::unique_ptr<Camera> readCameraFile(const std::string& path, const std::string& kalibr_camera) {
  return readCamera(Parameters::load(path), kalibr_camera);
}

std::unique_ptr<Camera> readCamera(const Parameters& parameters, const std::string& kalibr_camera) {
  if (!parameters.has("model_type") && parameters.has(kalibr_camera)) {
    return readKalibr(parameters, kalibr_camera);
  }
  return readCamodocal(parameters);
}

std::string toCamodocalYaml(const Camera& camera) {
  std::ostringstream text;
  text << "%YAML:1.0\n---\n"
       << "model_type: " << toString(camera.model()) << "\n"
       << "camera_name: \"" << camera.name() << "\"\n"
       << "image_width: " << camera.imageSize().width << "\n"
       << "image_height: " << camera.imageSize().height << "\n"
       << parametersText(camera);
  return text.str();
}

std::string toKalibrYaml(const Camera& camera, const std::string& kalibr_camera) {
  const CameraParameters p = camera.parameters();
  const bool has_k3 = camera.model() == CameraModel::kPinhole && p[8] != 0.0;
  if (camera.model() == CameraModel::kScaramuzza || has_k3) {
    throw InputError("camera '" + camera.name() + "': Kalibr has no form for " +
                     (has_k3 ? "PINHOLE with k3; calibrate without it" : "SCARAMUZZA"));
  }
  const bool is_omni = camera.model() == CameraModel::kMei;
  const bool is_equidistant = camera.model() == CameraModel::kKannalaBrandt;
  const std::vector<int> intrinsics = is_omni          ? std::vector<int>{0, 5, 6, 7, 8}
                                      : is_equidistant ? std::vector<int>{4, 5, 6, 7}
                                                       : std::vector<int>{0, 1, 2, 3};
  const std::vector<int> distortion = is_omni          ? std::vector<int>{1, 2, 3, 4}
                                      : is_equidistant ? std::vector<int>{0, 1, 2, 3}
                                                       : std::vector<int>{4, 5, 6, 7};
  std::ostringstream text;
  text << kalibr_camera << ":\n"
       << "  camera_model: " << (is_omni ? "omni" : "pinhole") << "\n"
       << "  intrinsics: " << listText(p, intrinsics) << "\n"
       << "  distortion_model: " << (is_equidistant ? "equidistant" : "radtan") << "\n"
       << "  distortion_coeffs: " << listText(p, distortion) << "\n"
       << "  resolution: [" << camera.imageSize().width << ", " << camera.imageSize().height
       << "]\n";
  return text.str();
}

}  // namespace vins::camera_model
