"""plot_map_growth, run as a user runs it."""

import os
import subprocess
import sys
import tempfile
import unittest

TOOL = os.path.join(os.path.dirname(__file__), "..", "plot_map_growth")
HEAD = ("time_s,distance_m,keyframes,loops,removed,resident_mb,graph_mb,query_ms,verify_ms,add_ms,"
        "optimize_ms,worst_optimize_ms,file_mb,save_s,position_error_m\n")


class MapGrowthPlot(unittest.TestCase):
    def run_on(self, text):
        with tempfile.TemporaryDirectory() as folder:
            table, plot = os.path.join(folder, "a.csv"), os.path.join(folder, "a.svg")
            with open(table, "w", encoding="utf-8") as file:
                file.write(text)
            done = subprocess.run([sys.executable, TOOL, plot, table], capture_output=True,
                                  text=True, check=False)
            drawn = ""
            if os.path.exists(plot):
                with open(plot, encoding="utf-8") as file:
                    drawn = file.read()
            return done, drawn

    def test_draws_a_table(self):
        rows = "60,80,120,0,0,50,5,1,1,2,0,0,4,0.1,0.2\n120,160,200,9,40,60,8,1,1,2,5,9,7,0.1,0.2\n"
        done, drawn = self.run_on(HEAD + rows)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("<svg", drawn)

    def test_tells_what_is_wrong(self):
        for text in ("", HEAD, "time_s,keyframes\n1,2\n"):
            done, drawn = self.run_on(text)
            self.assertEqual(done.returncode, 1)
            self.assertIn("plot_map_growth: ", done.stderr)
            self.assertEqual(drawn, "")


if __name__ == "__main__":
    unittest.main()
