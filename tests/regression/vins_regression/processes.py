"""Programs as processes: to start, to wait for, to interrupt and to kill."""

import os
import signal
import subprocess
import tempfile
import time

from vins_regression import files

NODES = ("feature_tracker", "vins_estimator", "pose_graph")


class Process:
    """A running program, whose output goes to a file."""

    def __init__(self, arguments, **options):
        """Starts it.

        Args:
            arguments: list of str, the program first.
            options: of subprocess.Popen.
        """
        self.name = os.path.basename(arguments[0])
        self._log = tempfile.TemporaryFile()
        # In a group of its own: what is sent to it does not reach the test.
        self._process = subprocess.Popen(
            arguments, stdin=subprocess.DEVNULL, stdout=self._log, stderr=subprocess.STDOUT,
            start_new_session=True, **options)

    @property
    def exit_code(self):
        """None while it runs; a signal that has ended it counts as its negative number."""
        return self._process.poll()

    def is_running(self):
        """Whether it has not ended yet."""
        return self.exit_code is None

    def output(self):
        """All that it has said so far."""
        self._log.seek(0)
        return self._log.read().decode(errors="replace")

    def send(self, number):
        """Sends a signal."""
        self._process.send_signal(number)

    def wait(self, timeout):
        """Seconds until it has ended, or None where it has not within timeout."""
        start = time.monotonic()
        try:
            self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            return None
        return time.monotonic() - start

    def interrupt(self, timeout):
        """Ctrl-C: seconds until it has ended, or None."""
        self.send(signal.SIGINT)
        return self.wait(timeout)

    def kill(self):
        """Ends it at once, in the middle of what it does, with all that it has started."""
        if self.is_running():
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()


def start_node(name, rig, *arguments, **options):
    """One of NODES.

    Args:
        rig: path of its configuration file.
        arguments: more for its command line, "_parameter:=value" or "topic:=other".
    """
    return Process([files.program(name, name), "__name:=" + name, "_config_file:=" + rig]
                   + list(arguments), **options)


def launch(file_name, **arguments):
    """A launch file of the workspace, as a user starts it."""
    words = ["%s:=%s" % item for item in arguments.items()]
    return Process(["roslaunch", "vins_estimator", file_name] + words)


def play(bag, *options):
    """A bag's camera and IMU in real time, once somebody listens to both."""
    return Process(["rosbag", "play", "--quiet", "--clock", "--delay", "1",
                    "--wait-for-subscribers", bag] + list(options)
                   + ["--topics", "/cam0/image_raw", "/imu0"])
