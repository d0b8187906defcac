"""The results as JSON, for regression limits and scripts."""

import json

from vins_evaluation.relative_error import RelativeErrors

# What each series is called in the file: with its unit.
_RELATIVE_NAMES = dict(zip(RelativeErrors.SERIES, (
    "translation_m", "translation_percent", "rotation_deg", "rotation_deg_per_m")))


def json_report(evaluation):
    """The results as JSON text; what is not known is null."""
    report = {
        "ground_truth": {
            "source": evaluation.source,
            "poses": len(evaluation.truth),
            "duration_s": evaluation.truth.duration,
            "distance_m": evaluation.path_length,
        },
        "settings": _settings(evaluation.settings),
        "estimates": [_estimate(result) for result in evaluation.results],
    }
    return json.dumps(report, indent=2, allow_nan=False) + "\n"


def _settings(settings):
    return {
        "align": settings.align,
        "max_gap_s": settings.max_gap,
        "max_truth_gap_s": settings.max_truth_gap,
        "start_s": settings.start,
        "duration_s": settings.duration,
        "time_offset_s": settings.time_offset,
    }


def _estimate(result):
    return {
        "name": result.name,
        "source": result.source,
        "poses": result.pose_count,
        "poses_compared": len(result.estimate),
        "completeness_percent": result.coverage.completeness,
        "longest_gap_s": result.coverage.longest_gap,
        "first_pose_after_s": result.coverage.first_pose,
        "alignment": _alignment(result.alignment),
        "ate_m": _statistics(result.statistics("position")),
        "rotation_deg": _statistics(result.statistics("rotation")),
        "yaw_deg": _statistics(result.statistics("yaw")),
        "tilt_deg": _statistics(result.statistics("tilt")),
        "scale_error_percent": result.scale_error,
        "rpe": [_relative(errors) for errors in result.relative],
    }


def _alignment(alignment):
    return {
        "scale": float(alignment.scale),
        "rotation_xyzw": [float(value) for value in alignment.quaternion],
        "translation_m": [float(value) for value in alignment.translation],
    }


def _relative(errors):
    report = {"distance_m": errors.distance, "sub_trajectories": len(errors)}
    for series, name in _RELATIVE_NAMES.items():
        report[name] = _statistics(errors.statistics(series))
    return report


def _statistics(statistics):
    return None if statistics is None else statistics.as_dict()
