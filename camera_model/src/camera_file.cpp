#include "camera_model/camera_file.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "camera_model/double_sphere.h"
#include "camera_model/eucm.h"
#include "camera_model/kannala_brandt.h"
#include "camera_model/mei.h"
#include "camera_model/pinhole_radtan.h"
#include "camera_model/scaramuzza.h"
#include "vins_core/input_error.h"
#include "vins_core/yaml_text.h"

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
    case CameraModel::kDoubleSphere:
      return std::make_unique<DoubleSphere>(name, size, p);
    case CameraModel::kEucm:
      return std::make_unique<Eucm>(name, size, p);
  }
  return nullptr;
}

/// Where there is no distortion, OpenCV's reader gives zeros.
bool hasDistortion(const Parameters& file) {
  if (file.has("distortion_parameters")) return true;
  file.remark("distortion_parameters",
              "no distortion_parameters: the lens is taken as free of distortion");
  return false;
}

/// Takes k4, k5 and k6 from a pinhole's parameters where all are zero: a polynomial is left.
void dropIdleDenominator(std::vector<double>* pinhole) {
  if (std::all_of(pinhole->begin() + 9, pinhole->end(), [](double k) { return k == 0.0; })) {
    pinhole->resize(9);
  }
}

std::vector<double> readPinhole(const Parameters& file) {
  std::vector<double> values;
  append(file.section("projection_parameters"), {"fx", "fy", "cx", "cy"}, &values);
  if (!hasDistortion(file)) {
    values.resize(values.size() + 5, 0.0);
    return values;
  }
  const Parameters distortion = file.section("distortion_parameters");
  append(distortion, {"k1", "k2", "p1", "p2"}, &values);
  for (const char* key : {"k3", "k4", "k5", "k6"}) values.push_back(distortion.numberOr(key, 0.0));
  dropIdleDenominator(&values);
  return values;
}

std::vector<double> readMei(const Parameters& file) {
  std::vector<double> values;
  append(file.section("mirror_parameters"), {"xi"}, &values);
  if (hasDistortion(file)) {
    append(file.section("distortion_parameters"), {"k1", "k2", "p1", "p2"}, &values);
  } else {
    values.resize(values.size() + 4, 0.0);
  }
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

/// Of the double sphere and the extended unified model, with the names of their own parameters.
std::vector<double> readUnified(const Parameters& file, const Names& own) {
  std::vector<double> values;
  append(file.section("mirror_parameters"), own, &values);
  append(file.section("projection_parameters"), {"fx", "fy", "cx", "cy"}, &values);
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
    case CameraModel::kDoubleSphere:
      return readUnified(file, {"xi", "alpha"});
    case CameraModel::kEucm:
      return readUnified(file, {"alpha", "beta"});
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
  Names models;
  for (const CameraModel model : kCameraModels) models.push_back(toString(model));
  const CameraModel model = cameraModelFromString(file.text("model_type", models));
  const std::string name = file.textOr("camera_name", "camera");
  const ImageSize size{file.integer("image_width", {1, 100000}),
                       file.integer("image_height", {1, 100000})};
  const CameraParameters parameters = toParameters(readValues(model, file));
  return namingFile(file, [&] { return makeCamera(model, name, size, parameters); });
}

/// How Kalibr names a model, and in which order it has our parameters.
struct KalibrForm {
  CameraModel model;
  const char* projection;
  const char* distortion;
  std::vector<int> intrinsics;  ///< indices of our parameters
  std::vector<int> coefficients;
};

const std::vector<KalibrForm>& kalibrForms() {
  static const std::vector<KalibrForm> kForms = {
      {CameraModel::kPinhole, "pinhole", "radtan", {0, 1, 2, 3}, {4, 5, 6, 7}},
      {CameraModel::kKannalaBrandt, "pinhole", "equidistant", {4, 5, 6, 7}, {0, 1, 2, 3}},
      {CameraModel::kMei, "omni", "radtan", {0, 5, 6, 7, 8}, {1, 2, 3, 4}},
      {CameraModel::kDoubleSphere, "ds", "none", {0, 1, 2, 3, 4, 5}, {}},
      {CameraModel::kEucm, "eucm", "none", {0, 1, 2, 3, 4, 5}, {}}};
  return kForms;
}

/// The form that a section has; "none" is radtan without distortion where it is no form of its own.
const KalibrForm& kalibrFormOf(const Parameters& section, bool* has_distortion) {
  const std::string projection = section.text("camera_model", {"pinhole", "omni", "ds", "eucm"});
  Names distortions;
  for (const KalibrForm& form : kalibrForms()) {
    if (projection == form.projection) distortions.push_back(form.distortion);
  }
  if (distortions.front() != "none") distortions.push_back("none");
  const std::string distortion = section.text("distortion_model", distortions);
  *has_distortion = distortion != "none";
  const std::string wanted = *has_distortion ? distortion : distortions.front();
  for (const KalibrForm& form : kalibrForms()) {
    if (projection == form.projection && wanted == form.distortion) return form;
  }
  return kalibrForms().front();
}

/// A side of an image as Kalibr writes it.
int pixels(double value) {
  constexpr double kLargest = 100000.0;
  if (!(value >= 1.0 && value <= kLargest)) {
    throw InputError("key 'resolution': found " + exactNumber(value) +
                     "; allowed: two whole numbers from 1 to 100000");
  }
  return static_cast<int>(value);
}

std::unique_ptr<Camera> readKalibr(const Parameters& file, const std::string& name) {
  const Parameters section = file.section(name);
  bool has_distortion = false;
  const KalibrForm& form = kalibrFormOf(section, &has_distortion);
  const std::size_t own = form.intrinsics.size() + form.coefficients.size();
  // More than Kalibr writes: k3 or k3, k4, k5, k6, as OpenCV gives them.
  const bool is_pinhole = form.model == CameraModel::kPinhole;
  std::vector<double> values(is_pinhole ? 12 : own, 0.0);
  const std::vector<double> intrinsics = section.numbers("intrinsics", {form.intrinsics.size()});
  for (std::size_t i = 0; i < intrinsics.size(); ++i) values[form.intrinsics[i]] = intrinsics[i];
  if (has_distortion) {
    const std::vector<double> k = is_pinhole ? section.numbers("distortion_coeffs", {4, 5, 8})
                                             : section.numbers("distortion_coeffs", {4});
    for (std::size_t i = 0; i < 4; ++i) values[form.coefficients[i]] = k[i];
    std::copy(k.begin() + 4, k.end(), values.begin() + static_cast<std::ptrdiff_t>(own));
  } else {
    section.know({"distortion_coeffs"});
  }
  if (is_pinhole) dropIdleDenominator(&values);
  const CameraParameters p = toParameters(values);
  const std::vector<double> resolution = section.numbers("resolution", {2});
  return namingFile(file, [&] {
    return makeCamera(form.model, name, {pixels(resolution[0]), pixels(resolution[1])}, p);
  });
}

std::string sectionText(const std::string& title, const Names& keys,
                        const std::vector<double>& values) {
  std::string text = title + ":\n";
  for (std::size_t i = 0; i < keys.size(); ++i) {
    text += "   " + keys[i] + ": " + exactNumber(values[i]) + "\n";
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

/// Coefficients of a pinhole's distortion that need be written.
int distortionCount(const Camera& pinhole) {
  const CameraParameters p = pinhole.parameters();
  if (p.size() > 9) return static_cast<int>(p.size()) - 4;
  return p[8] == 0.0 ? 4 : 5;
}

std::string parametersText(const Camera& camera) {
  switch (camera.model()) {
    case CameraModel::kPinhole:
      return sectionText("distortion_parameters", camera, 4, distortionCount(camera)) +
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
    case CameraModel::kDoubleSphere:
    case CameraModel::kEucm:
      return sectionText("mirror_parameters", camera, 0, 2) +
             sectionText("projection_parameters", camera, 2, 4);
  }
  return "";
}

std::string listText(const CameraParameters& p, const std::vector<int>& order) {
  std::string text;
  for (const int i : order) text += (text.empty() ? "" : ", ") + exactNumber(p[i]);
  return "[" + text + "]";
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
  const bool has_k3 = camera.model() == CameraModel::kPinhole && distortionCount(camera) > 4;
  if (camera.model() == CameraModel::kScaramuzza || has_k3) {
    throw InputError(
        "camera '" + camera.name() + "': Kalibr has no form for " +
        (has_k3 ? "PINHOLE with more than k1, k2, p1, p2; calibrate without them" : "SCARAMUZZA"));
  }
  const KalibrForm* form = nullptr;
  for (const KalibrForm& candidate : kalibrForms()) {
    if (candidate.model == camera.model()) form = &candidate;
  }
  std::ostringstream text;
  text << kalibr_camera << ":\n"
       << "  camera_model: " << form->projection << "\n"
       << "  intrinsics: " << listText(p, form->intrinsics) << "\n"
       << "  distortion_model: " << form->distortion << "\n"
       << "  distortion_coeffs: " << listText(p, form->coefficients) << "\n"
       << "  resolution: [" << camera.imageSize().width << ", " << camera.imageSize().height
       << "]\n";
  return text.str();
}

}  // namespace vins::camera_model
