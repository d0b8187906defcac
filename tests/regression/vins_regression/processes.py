"""Programs as processes: to start, to wait for, to interrupt and to kill."""

import os
import resource
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
        # ROS's log would else keep back what a node says until it ends.
        environment = dict(options.pop("env", os.environ), ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        # In a group of its own: what is sent to it does not reach the test.
        self._process = subprocess.Popen(
            arguments, stdin=subprocess.DEVNULL, stdout=self._log, stderr=subprocess.STDOUT,
            start_new_session=True, env=environment, **options)

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

    def wait_for_word(self, word, timeout):
        """Whether the program has said something within seconds."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if word in self.output():
                return True
            time.sleep(0.05)
        return False

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

    def discard(self):
        """Ends it in any way and forgets what it has said."""
        # What roslaunch has started is in groups of its own, which only roslaunch can end.
        if self.is_running() and self.interrupt(10.0) is None:
            self.kill()
        self._log.close()


def full_disk(left=0):
    """Options for Process: no file can grow beyond some bytes, as on a full disk.

    The program gets the error of a write that fails, not the signal that would end it.
    """
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (left, left))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    return {"preexec_fn": limit}


def start_node(name, rig, *arguments, **options):
    """One of NODES.

    Args:
        rig: path of its configuration file.
        arguments: more for its command line, "_parameter:=value" or "topic:=other".
        options: as Process takes them.
    """
    return Process([files.program(name, name), "_config_file:=" + rig] + list(arguments),
                   **options)


def launch(file_name, **arguments):
    """A launch file of the workspace, as a user starts it."""
    words = ["%s:=%s" % item for item in arguments.items()]
    return Process(["roslaunch", "vins_estimator", file_name] + words)


def play(bag, *options, **process_options):
    """A bag's camera and IMU in real time, once somebody listens to both."""
    return Process(["rosbag", "play", "--quiet", "--clock", "--delay", "1",
                    "--wait-for-subscribers", bag] + list(options)
                   + ["--topics", "/cam0/image_raw", "/imu0"], **process_options)
