"""Runs the fixed set of recordings through run_bag and compares with the baseline; see --help."""

import argparse
import json
import os
import subprocess
import sys

from vins_regression import files, recordings, results

_HERE = os.path.dirname(os.path.realpath(__file__))
BASELINE = os.path.join(_HERE, "baseline.json")
BOUNDS = os.path.join(_HERE, "bounds.json")
PAGE = os.path.join(files.WORKSPACE, "docs", "results.md")

_PAGE_TEXT = """# Results

What `run_bag` makes of a fixed set of recordings: simulated ones, which every machine renders
alike from a seed, EuRoC flights with their recorded IMU and rendered images, and a real one. This
table is the baseline with which

    scripts/regress

compares the code as it is; `scripts/regress --record` measures it anew and rewrites this page.
ATE is the position error (RMSE after alignment by position and yaw) of the odometry, each pose as
it was known at its moment; `with loops` is that of the path in the end. `initialised` and
`completeness` count from the first pose of the ground truth. The CPU time is that of tracker and
estimator together, and depends on the machine and what else it does; all else does not, but for the
last bits of another processor's arithmetic.

%s
## Bounds

No baseline may be beyond these sizes, about one and a half times what was measured when they were
set: they stand in `tests/regression/bounds.json`, which `--record` never changes. `scripts/regress`
fails beyond them, whatever the baseline says. A commit that loosens one says why.

%s
"""


def run(recording, out):
    """The figures of one recording; None where it is not here.

    Args:
        recording: recordings.Recording; out: folder for run_bag's files.
    """
    source = recording.prepare()
    if source is None:
        return None
    folder = os.path.join(out, recording.name)
    os.makedirs(folder, exist_ok=True)
    command = [files.program("vins_pipeline", "run_bag"), source.config, source.path, "--out",
               folder]
    if source.ground_truth:
        command += ["--ground-truth", source.ground_truth]
    print("regress: %s" % recording.name, flush=True)
    with open(os.path.join(folder, "log.txt"), "wb") as log:
        code = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                              check=False).returncode
    if code not in (0, 2):
        raise RuntimeError("run_bag ended with code %d: see %s/log.txt" % (code, folder))
    return results.read_run(folder)


def load_baseline():
    """{name: figures}; empty where there is none yet."""
    if not os.path.exists(BASELINE):
        return {}
    with open(BASELINE, encoding="utf-8") as file:
        return json.load(file)


def record(baseline, bounds):
    """Writes baseline and page; the bounds are shown, and stay as they are."""
    os.makedirs(os.path.dirname(PAGE), exist_ok=True)
    descriptions = {recording.name: recording.description for recording in recordings.ALL}
    for path, text in ((BASELINE, json.dumps(baseline, indent=2, sort_keys=True) + "\n"),
                       (PAGE, _PAGE_TEXT % (results.markdown_table(baseline, descriptions),
                                            results.bounds_table(bounds, descriptions)))):
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write(text.rstrip("\n") + "\n")
        os.replace(path + ".part", path)
        print("regress: written %s" % os.path.relpath(path, files.WORKSPACE))


def judge(figures, baseline, bounds):
    """Says what is clearly worse than the baseline or beyond its bounds; the exit code.

    Args:
        figures: {name: figures, None where it was not run}; baseline: {name: figures};
        bounds: as results.load_bounds gives them.
    """
    runs = {name: now for name, now in figures.items() if now}
    bad = [name for name, now in runs.items() if results.worse(now, baseline.get(name, {}))]
    print("regress: " + ("clearly worse: " + ", ".join(bad) if bad else "nothing is clearly worse"))
    for name, now in runs.items():
        for figure in results.beyond(now, bounds[name]):
            bad.append(name)
            print("regress: beyond its bound: %s, %s: %s, at most %s allowed"
                  % (name, figure.heading, now.get(figure.key), bounds[name][figure.key]))
    return 1 if bad else 0


def parser():
    """Of the command line."""
    tolerances = "\n".join("  %-24s%s" % (figure.heading, figure.tolerance)
                           for figure in results.FIGURES)
    made = argparse.ArgumentParser(
        prog="scripts/regress", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Runs a fixed set of recordings through run_bag and prints the figures beside "
                    "the baseline's.\nSimulated ones are rendered once, into the build folder; "
                    "real ones are looked for in\n../shared/data or where VINS_SHARED_DATA says.",
        epilog="clearly worse (marked by \"!\") is:\n%s\nexit code: 0 nothing is clearly worse, 1 something is or is beyond its bound, "
               "2 it could not be run\nAbsolute bounds, which hold whatever the baseline says: "
               "tests/regression/bounds.json" % tolerances)
    made.add_argument("--record", action="store_true",
                      help="make these figures the baseline: tests/regression/baseline.json and "
                           "docs/results.md; the bounds stay")
    made.add_argument("--only", metavar="NAME", nargs="+",
                      choices=[recording.name for recording in recordings.ALL],
                      help="of the set: " + ", ".join(r.name for r in recordings.ALL))
    made.add_argument("--out", default=os.path.join(files.WORKSPACE, "results", "regress"),
                      help="folder for what run_bag writes (default: results/regress)")
    return made


def main():
    """Runs, prints, and tells by the exit code."""
    options = parser().parse_args()
    chosen = [r for r in recordings.ALL if not options.only or r.name in options.only]
    baseline = load_baseline()
    bounds = results.load_bounds(BOUNDS, [recording.name for recording in recordings.ALL])
    figures = {recording.name: run(recording, options.out) for recording in chosen}
    print(results.text_table([(name, now, baseline.get(name)) for name, now in figures.items()]),
          end="")
    if options.record:
        record({**baseline, **{name: now for name, now in figures.items() if now}}, bounds)
        baseline = {}
    return judge(figures, baseline, bounds)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, RuntimeError, ValueError, subprocess.CalledProcessError) as error:
        print("regress: %s" % error, file=sys.stderr)
        sys.exit(2)
