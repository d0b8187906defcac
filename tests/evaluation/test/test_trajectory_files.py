"""Each text format, stamps to the nanosecond, and each complaint."""

import unittest

import numpy as np
from support import FolderTest, wandering, write_tum

from vins_evaluation.errors import EvaluationError
from vins_evaluation.trajectory_files import read_trajectory_file

# The next double is 128 ns away: read through a double these would differ.
STAMPS = [1403715274302142976, 1403715274307142913, 1403715274312143001]


class FormatsTest(FolderTest):

    def read(self, text):
        return read_trajectory_file(self.file("trajectory.txt", text))[0]

    def test_tum_keeps_every_nanosecond(self):
        poses = self.read("# timestamp tx ty tz qx qy qz qw\n"
                          "1403715274.302142976 1 2 3 0 0 0 1\n"
                          "\n"
                          "1403715274.307142913 4 5 6 0.6 0 0 0.8\n"
                          "1.403715274312143001e9\t7 8 9 0 0 0.8 0.6\n")
        self.assertEqual(poses.stamps.tolist(), STAMPS)
        np.testing.assert_array_equal(poses.positions, [[1, 2, 3], [4, 5, 6], [7, 8, 9]])
        np.testing.assert_allclose(poses.quaternions[1], [0.6, 0, 0, 0.8])

    def test_tum_fractions_finer_than_a_nanosecond_are_rounded(self):
        poses = self.read("0.1234567894 0 0 0 0 0 0 1\n0.1234567896 0 0 0 0 0 0 1\n")
        self.assertEqual(poses.stamps.tolist(), [123456789, 123456790])

    def test_euroc_csv(self):
        poses = self.read(
            "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x []\r\n"
            "1403715274302142976,1,2,3,0.8,0.6,0,0,9,9,9,9,9,9,9,9,9\r\n"
            "1403715274307142913,4,5,6,0.8,0,0.6,0,9,9,9,9,9,9,9,9,9\r\n")
        self.assertEqual(poses.stamps.tolist(), STAMPS[:2])
        np.testing.assert_array_equal(poses.positions, [[1, 2, 3], [4, 5, 6]])
        np.testing.assert_allclose(poses.quaternions, [[0.6, 0, 0, 0.8], [0, 0.6, 0, 0.8]])

    def test_vins_mono_csv_ends_in_a_comma(self):
        poses = self.read("1403715274302142976,1.00000,2.00000,3.00000,"
                          "0.80000,0.00000,0.00000,0.60000,9.0,9.0,9.0,\n"
                          "1403715274307142913, 1, 2, 3, 0.8, 0, 0, 0.6, 9, 9, 9,\n")
        self.assertEqual(poses.stamps.tolist(), STAMPS[:2])
        np.testing.assert_allclose(poses.quaternions[:, 2], 0.6)

    def test_vins_mono_loop_csv_has_poses_only(self):
        poses = self.read("1403715274302142976,1,2,3,0.8,0,0,0.6,\n")
        np.testing.assert_allclose(poses.quaternions, [[0, 0, 0.6, 0.8]])

    def test_positions_alone(self):
        for text in ("#t, x, y, z\n1403715274302142976,1,2,3\n",
                     "1403715274.302142976 1 2 3\n"):
            poses = self.read(text)
            self.assertEqual(poses.stamps.tolist(), STAMPS[:1])
            self.assertFalse(poses.has_orientation)

    def test_windows_byte_order_mark(self):
        self.assertEqual(len(self.read("\ufeff1 1 2 3 0 0 0 1\n")), 1)

    def test_coarse_quaternions_are_normalised(self):
        poses = self.read("1 0 0 0 0 0 0.707 0.707\n")
        self.assertAlmostEqual(np.linalg.norm(poses.quaternions[0]), 1.0, places=15)

    def test_a_written_trajectory_comes_back(self):
        poses = wandering()
        write_tum(self.path("t.txt"), poses)
        back, warnings = read_trajectory_file(self.path("t.txt"))
        self.assertEqual(back.stamps.tolist(), poses.stamps.tolist())
        np.testing.assert_allclose(back.positions, poses.positions, atol=1e-9)
        np.testing.assert_allclose(back.quaternions, poses.quaternions, atol=2e-9)
        self.assertEqual(warnings, [])

    def test_repeated_poses_are_dropped_and_told(self):
        path = self.file("t.txt", "# c\n1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"
                                  "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n")
        poses, warnings = read_trajectory_file(path)
        self.assertEqual(len(poses), 2)
        self.assertEqual(warnings, [path + ": dropped 2 repeated pose(s), the first at line 3"])


class ComplaintsTest(FolderTest):

    def assert_complaint(self, text, pattern):
        path = self.file("bad.txt", text)
        with self.assertRaisesRegex(EvaluationError, pattern) as caught:
            read_trajectory_file(path)
        self.assertIn(path, str(caught.exception))

    def test_nothing_to_read(self):
        with self.assertRaisesRegex(EvaluationError, "absent.txt: .*No such file"):
            read_trajectory_file(self.path("absent.txt"))
        with self.assertRaisesRegex(EvaluationError, "directory"):
            read_trajectory_file(self.folder)
        self.assert_complaint("", "no poses")
        self.assert_complaint("# only a comment\n\n", "no poses")

    def test_not_text(self):
        with open(self.path("b"), "wb") as file:
            file.write(b"\x89PNG\xff\xfe\x00")
        with self.assertRaisesRegex(EvaluationError, "not a text file"):
            read_trajectory_file(self.path("b"))

    def test_number_of_values(self):
        self.assert_complaint("1 0 0 0 0 0 1\n", "line 1: 7 values.*TUM")
        self.assert_complaint("1 0 0 0 0 0 0 1 5\n", "line 1: 9 values.*TUM")
        self.assert_complaint("#\n1,picture.png\n", "line 2: 2 values.*csv")
        self.assert_complaint("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n",
                              "line 2: 7 values where the lines above have 8")

    def test_not_numbers(self):
        self.assert_complaint("soon 0 0 0 0 0 0 1\n", "line 1: stamp 'soon'")
        self.assert_complaint("1 0 zero 0 0 0 0 1\n", "line 1: .*'zero'")
        self.assert_complaint("nan 0 0 0 0 0 0 1\n", "line 1: stamp 'nan' is not finite")
        self.assert_complaint("1e999999 0 0 0 0 0 0 1\n", "line 1: stamp .* too large")

    def test_not_finite(self):
        self.assert_complaint("1 0 0 0 0 0 0 1\n2 0 nan 0 0 0 0 1\n",
                              "line 2: position is not finite: 0 nan 0")
        self.assert_complaint("1 inf 0 0 0 0 0 1\n", "line 1: position is not finite")
        self.assert_complaint("1 0 0 0 0 0 nan 1\n", "line 1: quaternion .* norm nan")

    def test_quaternions_off_the_unit_sphere(self):
        self.assert_complaint("1 0 0 0 0 0 0 0\n", "line 1: quaternion x y z w = 0 0 0 0")
        self.assert_complaint("1 0 0 0 0 0 0.2 1\n", "line 1: .* norm 1.02")
        self.assert_complaint("5,0,0,0,1,0,0,0.2\n", "x y z w = 0 0 0.2 1 has norm")

    def test_order_of_stamps(self):
        self.assert_complaint("2 0 0 0 0 0 0 1\n#\n1.75 0 0 0 0 0 0 1\n",
                              r"line 3: stamp goes back by 0\.250000000 s after line 1")
        self.assert_complaint("2 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n",
                              "line 2: same stamp as line 1 but another pose")

    def test_units_of_stamps(self):
        self.assert_complaint("1403715274302142976 0 0 0 0 0 0 1\n", "nanoseconds where")
        self.assert_complaint("1403715274.3,0,0,0,1,0,0,0\n",
                              "line 1: stamp 1403715274.3 is not a whole number of nanosec")


if __name__ == "__main__":
    unittest.main()
