"""What vins_status says of what it has heard; no ROS is needed."""

import importlib.machinery
import importlib.util
import os
import struct
import sys
import unittest

sys.dont_write_bytecode = True
TOOL = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'tools', 'vins_status')
LOADER = importlib.machinery.SourceFileLoader('vins_status', TOOL)
vins_status = importlib.util.module_from_spec(
    importlib.util.spec_from_loader('vins_status', LOADER))
LOADER.exec_module(vins_status)


def healthy_board(now):
    board = vins_status.Board()
    board.hear_stage('/vins: feature tracker', 0, 'tracking', [('observations', '142')], now)
    board.hear_stage('/vins: estimator', 0, 'tracking', [('solve time [ms]', '8.23456')], now)
    board.hear_stage('/vins: pose graph', 0, 'mapping', [('loops', '7')], now)
    for i in range(40):
        board.hear_topic('/odometry', now - 2.0 + 0.05 * i)
    return board


class Meters(unittest.TestCase):
    def test_rate_of_regular_arrivals(self):
        meter = vins_status.Meter()
        for i in range(1000):
            meter.tick(0.005 * i)
        # 200 Hz exactly; only rounding of the times may come in.
        self.assertAlmostEqual(meter.rate(0.005 * 999), 200.0, places=6)

    def test_a_topic_that_has_stopped_fades_and_then_is_nothing(self):
        meter = vins_status.Meter()
        for i in range(21):
            meter.tick(0.05 * i)
        self.assertAlmostEqual(meter.rate(1.0), 20.0, places=6)
        # 20 intervals since 0, up to now.
        self.assertAlmostEqual(meter.rate(2.0), 10.0, places=6)
        self.assertEqual(meter.rate(1.0 + 2 * vins_status.WINDOW), 0.0)
        self.assertAlmostEqual(meter.age(4.0), 3.0)

    def test_nothing_heard(self):
        meter = vins_status.Meter()
        self.assertEqual(meter.rate(5.0), 0.0)
        self.assertIsNone(meter.age(5.0))


class Latencies(unittest.TestCase):
    def test_pairs_by_stamp(self):
        latency = vins_status.Latency()
        for i in range(10):
            latency.begin(i, 1.0 * i)
        for i in range(10):
            latency.end(i, 1.0 * i + (0.2 if i == 3 else 0.05))
        median, longest = latency.figures()
        self.assertAlmostEqual(median, 50.0, places=6)
        self.assertAlmostEqual(longest, 200.0, places=6)

    def test_what_was_never_seen_tells_nothing(self):
        latency = vins_status.Latency()
        latency.end(7, 1.0)
        self.assertIsNone(latency.figures())


class Boards(unittest.TestCase):
    def test_all_is_well(self):
        board = healthy_board(10.0)
        self.assertEqual(board.problems(10.0), [])
        page = board.text(10.0)
        for shown in ['tracking', 'mapping', '/odometry', '20.0 Hz', '142', '8.23', 'loops']:
            self.assertIn(shown, page)

    def test_a_warning_is_told_with_its_advice(self):
        board = healthy_board(10.0)
        board.hear_stage('/vins: estimator', 1, 'move sideways', [], 10.0)
        self.assertEqual(board.problems(10.0), ['estimator: move sideways'])
        self.assertIn('WARNING  move sideways', board.text(10.0))

    def test_a_stage_that_was_never_heard(self):
        board = vins_status.Board()
        self.assertFalse(board.is_complete())
        self.assertEqual(len(board.problems(1.0)), 3)

    def test_a_stage_that_has_fallen_silent(self):
        board = healthy_board(10.0)
        later = 10.5 + vins_status.SILENCE
        problems = board.problems(later)
        self.assertEqual(len([p for p in problems if 'has the node ended' in p]), 3)

    def test_a_topic_without_messages(self):
        board = healthy_board(10.0)
        board.expect_topic('/imu0')
        self.assertEqual(board.problems(10.0), ['/imu0: nothing comes'])
        self.assertIn('never', board.text(10.0))

    def test_diagnostics_of_others_are_none_of_ours(self):
        board = vins_status.Board()
        board.hear_stage('/camera: temperature', 2, 'hot', [], 1.0)
        self.assertNotIn('hot', board.text(1.0))

    def test_events_are_shown(self):
        board = healthy_board(10.0)
        board.hear_stage('/e: estimator', 0, 'tracking', [('event imu_gap', 'a gap of 80 ms')], 10.0)
        self.assertIn('imu_gap: a gap of 80 ms', board.text(10.0))


class Stamps(unittest.TestCase):
    def test_a_serialized_header(self):
        raw = struct.pack('<III', 5, 1403636579, 763555584) + b'rest'
        self.assertEqual(vins_status.stamp_of(raw), 1403636579763555584)


if __name__ == '__main__':
    unittest.main()
