"""What arguments mean, and the names that estimates get."""

import os
import unittest

from support import FolderTest, shared_data

from vins_evaluation.errors import EvaluationError
from vins_evaluation.sources import load, short_names

EUROC_LINE = "#t, p, q\n1403715274302142976,1,2,3,1,0,0,0,0,0,0\n"


class LoadTest(FolderTest):

    def asl_folder(self):
        os.makedirs(self.path("rec/mav0/state_groundtruth_estimate0"))
        self.file("rec/mav0/state_groundtruth_estimate0/data.csv", EUROC_LINE)
        return self.path("rec")

    def test_a_file(self):
        source = self.file("data.csv", EUROC_LINE)
        found = load(source)
        self.assertEqual(found.source, source)
        self.assertEqual(found.trajectory.stamps.tolist(), [1403715274302142976])
        self.assertEqual(found.warnings, [])

    def test_an_asl_folder_or_its_mav0(self):
        folder = self.asl_folder()
        for source in (folder, folder + "/", os.path.join(folder, "mav0")):
            self.assertEqual(len(load(source).trajectory), 1)

    def test_a_folder_without_ground_truth(self):
        with self.assertRaisesRegex(EvaluationError, "without EuRoC ground truth.*data.csv"):
            load(self.folder)

    def test_a_recorded_asl_folder(self):
        found = load(shared_data("euroc_mh01_flight")).trajectory
        self.assertTrue(found.has_orientation)
        # README of the data: 19.4 m.
        self.assertAlmostEqual(found.path_lengths()[-1], 19.4, places=1)


class NamesTest(unittest.TestCase):

    def test_names_are_short(self):
        self.assertEqual(
            short_names(["a/vins.txt", "b/loop.csv", "run.bag:/odom", "c/rec/"]),
            ["vins", "loop", "run:/odom", "rec"])

    def test_names_that_would_be_alike_stay_as_typed(self):
        self.assertEqual(short_names(["a/vins.txt", "b/vins.txt", "c.txt"]),
                         ["a/vins.txt", "b/vins.txt", "c"])

    def test_the_same_file_twice_is_numbered(self):
        self.assertEqual(short_names(["a.txt", "a.txt"]), ["a.txt (1)", "a.txt (2)"])


if __name__ == "__main__":
    unittest.main()
