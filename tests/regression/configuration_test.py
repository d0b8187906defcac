#!/usr/bin/python3
"""What is said of a configuration file: once, by run_bag or by the feature tracker."""

import os
import re

from vins_regression import files, processes
from vins_regression.live_case import LiveCase, run
from vins_regression.processes import NODES, start_node

VINS_MONO_FILE = os.path.join(files.WORKSPACE, "tests", "launch_files", "vins_mono_euroc.yaml")
SLIPS = """
max_cn:150
window_sise: 10
skip_distance: 0.1
my_own_key: 1
"""
READY = {"feature_tracker": "feature tracker, from", "vins_estimator": "estimator options:",
         "pose_graph": "pose graph options:"}


# The other two nodes leave it to the feature tracker.
SILENT = tuple(name for name in NODES if name != "feature_tracker")


def warnings_in(text):
    """What a program has said of the file: keys that it does not know, and mended text."""
    return re.findall(r"\S+:\d+: unknown key '\w+' is ignored(?:; did you mean '\w+'\?)?"
                      r"|\S+: mended as OpenCV reads it: line \d+: '\w+:'", text)


class ConfigurationTest(LiveCase):
    """A file in VINS-Mono's form, as it is and with slips of the pen."""

    def test_one_program_tells_what_is_wrong_with_the_file(self):
        rig = os.path.join(self.folder, "rig.yaml")
        with open(VINS_MONO_FILE, encoding="utf-8") as original, \
                open(rig, "w", encoding="utf-8") as copy:
            copy.write(original.read() + SLIPS)
        expected = self._warnings_of_run_bag(rig)
        self.assertEqual(len(expected), 5, expected)
        self.assertRegex(expected[0], "mended as OpenCV reads it: line [0-9]+: 'max_cn:'")
        self.assertRegex(expected[1], "'max_cn' is ignored; did you mean 'max_cnt'")
        self.assertEqual(self._warnings_of_node("feature_tracker", rig), expected)
        for name in SILENT:
            with self.subTest(name):
                self.assertEqual(self._warnings_of_node(name, rig), [])

    def test_keys_of_other_stages_and_of_vins_mono_are_known(self):
        self.assertEqual(self._warnings_of_run_bag(VINS_MONO_FILE), [])
        for name in NODES:
            with self.subTest(name):
                self.assertEqual(self._warnings_of_node(name, VINS_MONO_FILE), [])

    def _warnings_of_run_bag(self, rig):
        # Without a recording it comes no further than the configuration.
        tool = self.started(processes.Process(
            [files.program("vins_pipeline", "run_bag"), rig, os.path.join(self.folder, "no.bag")]))
        self.assertIsNotNone(tool.wait(30.0), "still runs")
        self.assertIn("no.bag", tool.output())
        return warnings_in(tool.output())

    def _warnings_of_node(self, name, rig):
        node = self.started(start_node(name, rig))
        self.assertTrue(node.wait_for_word(READY[name], 20.0), node.output())
        found = warnings_in(node.output())
        self.assert_ends(node)
        return found


if __name__ == "__main__":
    run("configuration_test", ConfigurationTest)
