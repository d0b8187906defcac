"""Figures of run_bag on a fixed set of recordings, beside those of a baseline."""

import collections
import json
import os

# A figure's key, heading, format, and what is clearly worse than the baseline: run_bag gives the
# same bytes on every run, so each difference is the code's (or another processor's arithmetic).
Figure = collections.namedtuple("Figure", "key heading format is_worse tolerance")

FIGURES = (
    Figure("ate_m", "ATE [m]", "%.3f",
           lambda now, before: now > 1.25 * before + 0.01, "a quarter and 1 cm more"),
    Figure("loop_ate_m", "with loops [m]", "%.3f",
           lambda now, before: now > 1.25 * before + 0.01, "a quarter and 1 cm more"),
    Figure("scale_error_percent", "scale error [%]", "%+.2f",
           lambda now, before: abs(now) > abs(before) + 0.3, "0.3 points more"),
    Figure("initialised_s", "initialised [s]", "%.1f",
           lambda now, before: now > before + 1.0, "1 s later"),
    Figure("completeness_percent", "completeness [%]", "%.1f",
           lambda now, before: now < before - 2.0, "2 points less"),
    Figure("frame_ms", "CPU/frame [ms]", "%.1f",
           lambda now, before: now > 1.5 * before + 2.0, "half and 2 ms more"),
    Figure("loops", "loops", "%d",
           lambda now, before: now < 0.75 * before - 1.0, "a quarter and one less"),
)


# Figures that may have an absolute bound: the largest size that is allowed.
BOUNDED = ("ate_m", "loop_ate_m", "scale_error_percent", "initialised_s")


def read_run(folder):
    """The figures of a folder that run_bag has written.

    Returns:
        {Figure.key: number}; None for what is not known, as where it never initialised.
    """
    figures = {figure.key: None for figure in FIGURES}
    with open(os.path.join(folder, "events.csv"), encoding="utf-8") as file:
        figures["loops"] = sum(",loop_found," in line for line in file)
    stage = _json(folder, "timing.json")["stages"].get("tracker+estimator")
    if stage:
        figures["frame_ms"] = round(1e3 * stage["cpu_seconds"] / stage["count"], 2)
    if not os.path.exists(os.path.join(folder, "evaluation.json")):
        return figures
    estimates = {estimate["name"]: estimate
                 for estimate in _json(folder, "evaluation.json")["estimates"]}
    live = estimates["vio_live"]
    figures["ate_m"] = round(live["ate_m"]["rmse"], 4)
    figures["loop_ate_m"] = round(estimates["loop_final"]["ate_m"]["rmse"], 4)
    figures["scale_error_percent"] = round(live["scale_error_percent"], 3)
    figures["initialised_s"] = round(live["first_pose_after_s"], 2)
    figures["completeness_percent"] = round(live["completeness_percent"], 2)
    return figures


def _json(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file)


def worse(now, before):
    """The Figures in which a run is clearly worse than the baseline's.

    Args:
        now, before: {Figure.key: number or None}. A figure that is lost is worse; one that the
            baseline does not have is not.
    """
    return [figure for figure in FIGURES
            if before.get(figure.key) is not None
            and (now.get(figure.key) is None
                 or figure.is_worse(now[figure.key], before[figure.key]))]


def load_bounds(path, names):
    """Absolute bounds of the recordings: {name: {Figure.key: largest size}}.

    Args:
        path: of the JSON file; names: of all recordings, each of which must have all of BOUNDED.

    Raises:
        ValueError: names file, recording and figure of what is missing, unknown or no number above
            zero.
    """
    with open(path, encoding="utf-8") as file:
        bounds = json.load(file)
    for name in sorted(set(names) | set(bounds)):
        if name not in names:
            raise ValueError("%s: unknown recording %s; known: %s" % (path, name, ", ".join(names)))
        for key in sorted(set(BOUNDED) | set(bounds.get(name, {}))):
            value = bounds.get(name, {}).get(key)
            if key not in BOUNDED:
                raise ValueError("%s: %s: unknown figure %s; known: %s"
                                 % (path, name, key, ", ".join(BOUNDED)))
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0.0:
                raise ValueError("%s: %s: %s is %s; needed is a number above 0"
                                 % (path, name, key, value))
    return bounds


def beyond(now, bounds):
    """The Figures in which a run is beyond its absolute bounds.

    Args:
        now: {Figure.key: number or None}; a figure that is lost is beyond its bound.
        bounds: {Figure.key: largest size that is allowed}.
    """
    return [figure for figure in FIGURES
            if figure.key in bounds
            and (now.get(figure.key) is None or abs(now[figure.key]) > bounds[figure.key])]


def text_table(rows):
    """A table for the terminal: a line for each run, and below it one for its baseline.

    Args:
        rows: list of (name, now or None, before or None). What is clearly worse has a "!" behind.
    """
    headings = [figure.heading for figure in FIGURES]
    lines = ["%-12s%s" % ("", "".join("%*s " % (len(text) + 2, text) for text in headings))]
    for name, now, before in rows:
        if now is None:
            lines.append("%-12snot run: its recording is not here (VINS_SHARED_DATA)" % name)
        else:
            lines.append(_line(name, now, worse(now, before or {})))
        lines.append(_line("  baseline", before or {}, []))
    return "\n".join(line.rstrip() for line in lines) + "\n"


def _line(name, figures, marked):
    cells = ["%*s%s" % (len(figure.heading) + 2, _shown(figure, figures),
                        "!" if figure in marked else " ") for figure in FIGURES]
    return "%-12s%s" % (name, "".join(cells))


def markdown_table(baseline, descriptions):
    """The baseline for docs/results.md.

    Args:
        baseline: {name: figures}; descriptions: {name: what the recording is}.
    """
    lines = ["| recording | " + " | ".join(figure.heading for figure in FIGURES) + " |",
             "|---" * (len(FIGURES) + 1) + "|"]
    for name, text in descriptions.items():
        if name in baseline:
            cells = [_shown(figure, baseline[name]) for figure in FIGURES]
            lines.append("| %s | %s |" % (text, " | ".join(cells)))
    return "\n".join(lines) + "\n"


def bounds_table(bounds, descriptions):
    """The absolute bounds for docs/results.md.

    Args:
        bounds: {name: {Figure.key: largest size}}; descriptions: {name: what the recording is}.
    """
    shown = [figure for figure in FIGURES if figure.key in BOUNDED]
    lines = ["| recording | " + " | ".join(figure.heading for figure in shown) + " |",
             "|---" * (len(shown) + 1) + "|"]
    for name, text in descriptions.items():
        cells = [(figure.format % bounds[name][figure.key]).lstrip("+") for figure in shown]
        lines.append("| %s | %s |" % (text, " | ".join(cells)))
    return "\n".join(lines) + "\n"


def _shown(figure, figures):
    value = figures.get(figure.key)
    return "-" if value is None else figure.format % value
