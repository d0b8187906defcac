#!/usr/bin/python3
"""run_bag on a real handheld walk through a plain room, with the shipped template's settings.

The recording has no ground truth. What is judged is what a user sees: that it starts soon, holds to
the end, finds the clocks' offset, and stays in a room.
"""

import csv
import os
import re
import subprocess
import tempfile
import unittest

from vins_regression import files

TEMPLATE = os.path.join(files.WORKSPACE, "config", "realsense_d435i",
                        "realsense_d435i_config.yaml")
# The camera as its maker gives it; all else is the template's.
CAMERA = {"image_height": "360", "fx": "453.13", "fy": "453.275", "cx": "321.198", "cy": "176.321",
          "imu_topic": '"/imu0"', "image_topic": '"/cam0/image_raw"'}
TRANSLATION = "data: [-0.01206, 0.00218, 0.00238]"


def configuration(folder):
    """The template with this camera; its path."""
    with open(TEMPLATE, encoding="utf-8") as file:
        text = file.read()
    for key, value in CAMERA.items():
        text, count = re.subn(r"(?m)^(\s*%s:).*$" % key, r"\1 " + value, text)
        assert count == 1, key
    text, count = re.subn(r"data: \[0\.0055.*?\]", TRANSLATION, text)
    assert count == 1
    path = os.path.join(folder, "rig.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


class RoomWalkTest(unittest.TestCase):
    """One run, of which all is judged."""

    def test_it_starts_and_stays(self):
        recording = files.real_recording("room_walk")  # skips where it is missing
        with tempfile.TemporaryDirectory() as folder:
            command = [files.program("vins_pipeline", "run_bag"), configuration(folder), recording,
                       "--out", folder]
            subprocess.run(command, check=True, stdin=subprocess.DEVNULL,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(os.path.join(folder, "events.csv"), encoding="utf-8") as file:
                codes = [row["code"] for row in csv.DictReader(file)]
            stamps, positions = self._poses(os.path.join(folder, "vio_live.txt"))
            with open(os.path.join(folder, "estimator.csv"), encoding="utf-8") as file:
                td = float(list(csv.DictReader(file))[-1]["td [s]"])
        first_image = 1650458788.904403925
        print("first pose after %.2f s, %d poses, td %.4f s" % (stamps[0] - first_image,
                                                               len(stamps), td), flush=True)
        self.assertLess(stamps[0] - first_image, 3.0)
        self.assertNotIn("reset", codes)
        self.assertGreater(len(stamps), 0.95 * 1122, "of the recording's images")
        # By correlation with the gyroscope, before any estimator: -0.060 s, less half the read-out.
        self.assertTrue(-0.07 < td < -0.04, td)
        for axis in range(3):
            extent = max(p[axis] for p in positions) - min(p[axis] for p in positions)
            self.assertLess(extent, 4.0, "the room's size, axis %d" % axis)

    @staticmethod
    def _poses(path):
        stamps, positions = [], []
        with open(path, encoding="utf-8") as file:
            for line in file:
                if line.startswith("#"):
                    continue
                values = [float(value) for value in line.split()]
                stamps.append(values[0])
                positions.append(values[1:4])
        return stamps, positions


if __name__ == "__main__":
    unittest.main()
