"""Arguments, messages and exit codes of the tool evaluate_trajectory."""

import argparse
import math
import os
import shlex
import sys

from vins_evaluation import alignment, sources
from vins_evaluation.errors import EvaluationError
from vins_evaluation.evaluation import Settings, evaluate
from vins_evaluation.json_report import json_report
from vins_evaluation.text_table import text_table

_DESCRIPTION = """\
Measure estimated trajectories against ground truth and print a table of the
errors. A trajectory is a TUM file, a csv file of EuRoC or VINS-Mono, a EuRoC
ASL folder (its ground truth), or a topic of a bag as FILE.bag:/topic.
"""
_EPILOG = """\
exit code: 0 evaluated, 1 input that cannot be evaluated, 2 wrong usage, 130 interrupted
"""


def main(arguments):
    """Run the tool.

    Args:
        arguments: list of str, without the program's name.
    Returns:
        the exit code.
    """
    parser = _parser()
    options = parser.parse_intermixed_args(arguments)
    if options.names and len(options.names) != len(options.estimates):
        parser.error("%d --names for %d estimates"
                     % (len(options.names), len(options.estimates)))
    try:
        _run(options, shlex.join(["evaluate_trajectory"] + arguments))
    except EvaluationError as error:
        print("evaluate_trajectory: error: %s" % error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("evaluate_trajectory: interrupted", file=sys.stderr)
        return 130
    return 0


def _run(options, command):
    truth = _load(options.ground_truth)
    estimates = [_load(source) for source in options.estimates]
    names = options.names or sources.short_names(options.estimates)
    evaluation = evaluate(truth, estimates, _settings(options), names)
    print(text_table(evaluation), end="")
    if options.json:
        _write(options.json, json_report(evaluation))
    if options.html:
        # Matplotlib takes a second to import, which a table need not wait for.
        from vins_evaluation.html_report import html_report
        _write(options.html, html_report(evaluation, command))


def _load(source):
    loaded = sources.load(source)
    for warning in loaded.warnings:
        print("evaluate_trajectory: warning: %s" % warning, file=sys.stderr)
    return loaded


def _settings(options):
    return Settings(align=options.align, distances=options.distances,
                    max_gap=options.max_gap, max_truth_gap=options.max_truth_gap,
                    start=options.start, duration=options.duration,
                    time_offset=options.t_offset)


def _write(path, text):
    """Write aside, then rename: never a report that is half written."""
    aside = path + ".part"
    try:
        with open(aside, "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(aside, path)
    except OSError as error:
        raise EvaluationError("%s: cannot write it: %s" % (path, error.strerror)) from error
    finally:
        # Still there where writing failed or was interrupted.
        if os.path.exists(aside):
            os.remove(aside)


def _number(text):
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError("%r is not finite" % text)
    return value


def _positive(text):
    value = _number(text)
    if value <= 0.0:
        raise argparse.ArgumentTypeError("%r is not above 0" % text)
    return value


def _not_negative(text):
    value = _number(text)
    if value < 0.0:
        raise argparse.ArgumentTypeError("%r is below 0" % text)
    return value


def _parser():
    parser = argparse.ArgumentParser(
        prog="evaluate_trajectory", description=_DESCRIPTION, epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ground_truth", metavar="GROUND_TRUTH")
    parser.add_argument("estimates", metavar="ESTIMATE", nargs="+")
    _add_measuring_options(parser)
    _add_report_options(parser)
    return parser


def _add_measuring_options(parser):
    defaults = Settings()
    group = parser.add_argument_group("measuring")
    group.add_argument("--align", choices=alignment.KINDS, default=defaults.align,
                       help="how to move each estimate onto the ground truth "
                            "(default: %(default)s)")
    group.add_argument("--distances", metavar="M", nargs="+", type=_positive,
                       help="lengths of sub-trajectories for the relative error, metres "
                            "(default: up to five that suit the ground truth)")
    group.add_argument("--max-gap", metavar="S", type=_positive, default=defaults.max_gap,
                       help="an estimate counts as complete between poses at most this "
                            "many seconds apart (default: %(default)s)")
    group.add_argument("--max-truth-gap", metavar="S", type=_positive,
                       default=defaults.max_truth_gap,
                       help="interpolate the ground truth only between poses at most this "
                            "many seconds apart (default: %(default)s)")
    group.add_argument("--start", metavar="S", type=_not_negative, default=defaults.start,
                       help="seconds of the ground truth to skip (default: 0)")
    group.add_argument("--duration", metavar="S", type=_positive,
                       help="seconds to evaluate from there (default: to the end)")
    group.add_argument("--t-offset", metavar="S", type=_number, default=defaults.time_offset,
                       help="seconds to add to the estimates' stamps (default: 0)")


def _add_report_options(parser):
    group = parser.add_argument_group("reports")
    group.add_argument("--names", metavar="NAME", nargs="+",
                       help="what to call the estimates, in their order")
    group.add_argument("--json", metavar="FILE", help="write the figures as JSON")
    group.add_argument("--html", metavar="FILE",
                       help="write a page with tables and plots that needs no other file")
