#pragma once

#include <memory>
#include <vector>

#include "camera_model/double_sphere.h"
#include "camera_model/eucm.h"
#include "camera_model/kannala_brandt.h"
#include "camera_model/mei.h"
#include "camera_model/pinhole_radtan.h"
#include "camera_model/scaramuzza.h"

namespace vins::camera_model::testing {

inline CameraParameters parametersOf(std::initializer_list<double> values) {
  CameraParameters p(static_cast<int>(values.size()));
  std::copy(values.begin(), values.end(), p.data());
  return p;
}

/// A realistic camera of each model: EuRoC's cam0, TUM-VI's fisheye, a 180 degree omnidirectional
/// camera with distortion, an OCam lens that sees 20 degrees behind itself, and wide lenses as a
/// double sphere and as an extended unified camera.
inline std::vector<std::shared_ptr<const Camera>> exampleCameras() {
  return {
      std::make_shared<PinholeRadtan>("pinhole", ImageSize{752, 480},
                                      parametersOf({458.654, 457.296, 367.215, 248.375, -0.28340811,
                                                    0.07395907, 0.00019359, 1.76187114e-05, 0.0})),
      std::make_shared<KannalaBrandt>(
          "fisheye", ImageSize{512, 512},
          parametersOf({0.0034823894022493434, 0.0007150348452162257, -0.0020532361418706202,
                        0.00020293673591811182, 190.97847715128717, 190.9733070521226,
                        254.93170605935475, 256.8974428996504})),
      std::make_shared<Mei>(
          "omni", ImageSize{640, 480},
          parametersOf({1.2, -0.12, 0.03, 0.0006, -0.0004, 380.0, 382.0, 318.0, 244.0})),
      std::make_shared<Scaramuzza>(
          "ocam", ImageSize{800, 800},
          parametersOf({-280.0, 0.0, 1.1e-3, -4.0e-7, 1.9e-9, 1.0002, 0.0003, 0.0, 402.0, 397.0})),
      std::make_shared<DoubleSphere>("double_sphere", ImageSize{512, 512},
                                     parametersOf({-0.1725, 0.5933, 158.0, 157.9, 254.96, 256.89})),
      std::make_shared<Eucm>("eucm", ImageSize{640, 480},
                             parametersOf({0.63, 1.05, 260.0, 261.0, 318.0, 243.0}))};
}

}  // namespace vins::camera_model::testing
