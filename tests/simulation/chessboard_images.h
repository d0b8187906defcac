#pragma once

#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "camera_model/chessboard.h"
#include "simulation/random.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// How the images of a chessboard are formed.
struct ChessboardImageOptions {
  double blur = 0.7;         ///< deviation of the lens' blur [px]
  double noise = 2.0;        ///< deviation of the pixels' noise [gray levels]
  int samples_per_side = 4;  ///< of each pixel: its gray is the mean over a grid of rays
};

/// A pose T_cb at which the camera sees all squares of the board: an outermost corner of it lies on
/// the ray of a random pixel, and its plane is tilted by up to 45 degrees and turned at random.
/// Throws InputError where the camera sees none of a thousand such boards.
Pose randomBoardPose(const camera_model::Camera& camera, const camera_model::Chessboard& board,
                     Random* random);

/// 8-bit gray image of the board at T_cb, through the camera: dark and bright squares, a bright
/// margin one square wide, a gray background.
cv::Mat renderChessboard(const camera_model::Camera& camera, const camera_model::Chessboard& board,
                         const Pose& T_cb, const ChessboardImageOptions& options, Random* random);

}  // namespace vins::simulation
