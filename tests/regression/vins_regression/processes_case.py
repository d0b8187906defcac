"""A test case that looks after processes and a folder."""

import shutil
import unittest

from vins_regression import files


class ProcessCase(unittest.TestCase):
    """Ends all that a test has started, and removes its folder."""

    def setUp(self):
        self.processes = []
        self.folder = files.work_folder()
        self.addCleanup(self._end)

    def _end(self):
        for process in self.processes:
            process.discard()
        shutil.rmtree(self.folder, ignore_errors=True)

    def started(self, process):
        """Takes a Process into the case's care."""
        self.processes.append(process)
        return process

    def assert_ends(self, process, within=2.0, code=0):
        """Ctrl-C ends the process within seconds, with an exit code."""
        took = process.interrupt(10.0)
        self.assertIsNotNone(took, "%s still runs 10 s after Ctrl-C" % process.name)
        self.assertLess(took, within, process.name)
        self.assertEqual(process.exit_code, code, process.output())

    def said(self):
        """What the processes have said, for a failure's message."""
        return "\n".join("--- %s (%s)\n%s" % (process.name, process.exit_code, process.output())
                         for process in self.processes)
