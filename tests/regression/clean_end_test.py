#!/usr/bin/python3
"""How the nodes end: by Ctrl-C, by a second instance, without a master, on a full disk."""

import os
import socket

from vins_regression import files, processes, simulated_bags
from vins_regression.live_case import LiveCase, run
from vins_regression.processes import NODES, start_node

SECOND = 10**9
START = 1600000000 * SECOND  # of simulated bags


def free_port():
    """A port that nobody listens to."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class CleanEndTest(LiveCase):
    """Each end comes with a clear word and its exit code."""

    def test_ctrl_c_in_flight_on_a_full_disk(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        listener = self.listen()
        # Nodes write nothing but ROS's log; that it cannot be written is no reason to fall.
        nodes = {name: self.started(start_node(name, bag.rig, **processes.full_disk()))
                 for name in NODES}
        self.play(bag.bag)
        self.wait_for_odometry(listener, START + 5 * SECOND, 30.0)
        for node in nodes.values():
            self.assert_ends(node)

    def test_a_second_instance_takes_the_place_of_the_first(self):
        rig = simulated_bags.simulated(simulated_bags.LOOP).rig
        first = self.start_nodes(rig)
        self.wait_for_nodes()
        second = self.start_nodes(rig)
        for name, node in first.items():
            self.assertIsNotNone(node.wait(10.0), "%s still runs" % name)
            self.assertEqual(node.exit_code, 0, node.output())
            self.assertIn("new node registered with same name", node.output())
        for node in second.values():
            self.assertTrue(node.is_running(), node.output())
            self.assert_ends(node)

    def test_what_stops_a_node_from_starting_is_told(self):
        rig = simulated_bags.simulated(simulated_bags.LOOP).rig
        cases = [(name, [], "/no/such.yaml", "/no/such.yaml: cannot be opened") for name in NODES]
        cases += [(name, ["__name:=7"], rig, "is not valid") for name in NODES]
        cases += [("feature_tracker", ["_image_transport:=pigeon"], rig, "'pigeon'")]
        for name, arguments, config, word in cases:
            with self.subTest(name, word=word):
                node = self.started(start_node(name, config, *arguments))
                self.assertIsNotNone(node.wait(10.0), "still runs")
                self.assertIn(name + ": ", node.output())
                self.assertIn(word, node.output())
                self.assertEqual(node.exit_code, 1, node.output())

    def test_without_a_master_a_node_waits(self):
        rig = simulated_bags.simulated(simulated_bags.LOOP).rig
        alone = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % free_port())
        for name in NODES:
            # Parameters of the command line are set by ROS before it heeds Ctrl-C: ended by signal.
            for config, code in (("_config_file:=" + rig, -2), ("__log:=/dev/null", 1)):
                command = [files.program(name, name), config]
                node = self.started(processes.Process(command, env=alone))
                self.assertTrue(node.wait_for_word("Failed to contact master", 10.0))
                self.assert_ends(node, code=code)
                if code == 1:
                    self.assertIn("ended before a ROS master was there", node.output())

    def test_when_the_master_dies_the_flight_goes_on(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        port = str(free_port())
        own = {"env": dict(os.environ, ROS_MASTER_URI="http://localhost:" + port)}
        master = self.started(processes.Process(["rosmaster", "--core", "-p", port], **own))
        nodes = {name: self.started(start_node(name, bag.rig, **own)) for name in NODES}
        player = self.started(processes.play(bag.bag, **own))
        self.assertTrue(nodes["vins_estimator"].wait_for_word("init_little", 20.0),
                        "no feature has reached the estimator:\n" + self.said())
        master.kill()
        self.assertTrue(nodes["vins_estimator"].wait_for_word("initialized", 10.0), self.said())
        for node in nodes.values():
            self.assertTrue(node.is_running(), node.output())
            self.assert_ends(node)
        player.kill()


if __name__ == "__main__":
    run("clean_end_test", CleanEndTest)
