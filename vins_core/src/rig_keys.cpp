#include "vins_core/rig_keys.h"

#include <iterator>

namespace vins {
namespace {

constexpr const char* kKeys[] = {
    // Topics and results
    "imu_topic",
    "image_topic",
    "camera_info_topic",
    "accel_topic",
    "output_path",
    // Camera
    "model_type",
    "camera_name",
    "image_width",
    "image_height",
    "projection_parameters",
    "distortion_parameters",
    "mirror_parameters",
    "poly_parameters",
    "affine_parameters",
    "inv_poly_parameters",
    "cam0",
    "cam1",
    // Camera in the body frame
    "estimate_extrinsic",
    "extrinsicRotation",
    "extrinsicTranslation",
    "extrinsic_rotation_sigma",
    "extrinsic_translation_sigma",
    // Time
    "td",
    "estimate_td",
    "td_sigma",
    "rolling_shutter",
    "rolling_shutter_tr",
    // IMU
    "acc_n",
    "gyr_n",
    "acc_w",
    "gyr_w",
    "imu_noise_unit",
    "imu_rate",
    "g_norm",
    "vibration_share",
    "accelerometer_noise_density",
    "gyroscope_noise_density",
    "accelerometer_random_walk",
    "gyroscope_random_walk",
    "imu0",
    "update_rate",
    "rostopic",
    // Feature tracker
    "max_cnt",
    "min_dist",
    "freq",
    "F_threshold",
    "equalize",
    "show_track",
    "fisheye",
    "fisheye_mask",
    "min_tracks",
    "feature_border",
    "corner_quality",
    "klt_window",
    "klt_levels",
    "klt_backward",
    "max_image_gap",
    "tracker_seed",
    // Estimator
    "window_size",
    "keyframe_parallax",
    "pixel_noise",
    "max_num_iterations",
    "max_solver_time",
    "motion_only_ba",
    // Self-calibration
    "estimate_readout",
    "readout_sigma",
    "estimate_intrinsics",
    "focal_length_sigma",
    "principal_point_sigma",
    "distortion_sigma",
    "estimate_imu_intrinsics",
    "imu_intrinsics_sigma",
    // Loops and maps
    "loop_closure",
    "fast_relocalization",
    "min_loop_inliers",
    "loop_max_drift",
    "position_drift",
    "yaw_drift",
    "max_keyframes",
    "skip_dis",
    "skip_cnt",
    "load_previous_pose_graph",
    "pose_graph_save_path",
    "save_image",
    "vocabulary_file",
    "brief_pattern_file",
    // VINS-Fusion's form, and more cameras
    "imu",
    "num_of_cam",
    "image0_topic",
    "image1_topic",
    "cam0_calib",
    "cam1_calib",
    "body_T_cam0",
    "body_T_cam1",
    "td1",
    "multiple_thread",
    "flow_back",
    "use_gpu",
    "use_gpu_good_feature",
    "use_gpu_acc_flow",
    // OpenVINS's form
    "relative_config_imu",
    "relative_config_imucam",
    "max_cameras",
    "calib_cam_extrinsics",
    "calib_cam_timeoffset",
    "gravity_mag",
    // Of VINS-Mono, without effect
    "visualize_imu_forward",
    "visualize_camera_size",
};

}  // namespace

std::vector<std::string> rigKeys() { return {std::begin(kKeys), std::end(kKeys)}; }

}  // namespace vins
