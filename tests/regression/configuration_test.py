#!/usr/bin/python3
"""What the nodes say of keys in the configuration file: the same as run_bag."""

import os
import re

from vins_regression import files, processes
from vins_regression.live_case import LiveCase, run
from vins_regression.processes import NODES, start_node

VINS_MONO_FILE = os.path.join(files.WORKSPACE, "tests", "launch_files", "vins_mono_euroc.yaml")
SLIPS = """
max_cn: 150
window_sise: 10
skip_distance: 0.1
my_own_key: 1
"""
READY = {"feature_tracker": "feature tracker, from", "vins_estimator": "estimator options:",
         "pose_graph": "pose graph options:"}


def warnings_in(text):
    """What a program has said of keys that it does not know."""
    return re.findall(r"\S+:\d+: unknown key '\w+' is ignored(?:; did you mean '\w+'\?)?", text)


class ConfigurationTest(LiveCase):
    """A file in VINS-Mono's form, as it is and with slips of the pen."""

    def test_every_node_names_the_keys_that_run_bag_names(self):
        rig = os.path.join(self.folder, "rig.yaml")
        with open(VINS_MONO_FILE, encoding="utf-8") as original, \
                open(rig, "w", encoding="utf-8") as copy:
            copy.write(original.read() + SLIPS)
        expected = self._warnings_of_run_bag(rig)
        self.assertEqual(len(expected), 4, expected)
        self.assertRegex(expected[0], "'max_cn' is ignored; did you mean 'max_cnt'")
        for name in NODES:
            with self.subTest(name):
                self.assertEqual(self._warnings_of_node(name, rig), expected)

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
