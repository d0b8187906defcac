"""The figures as a plain text table."""

from vins_evaluation import figures

_GAP = "  "


def text_table(evaluation):
    """The whole report as text; the best of several estimates marked with *."""
    lines = _heading(evaluation)
    names = [result.name for result in evaluation.results]
    rows = [["", ""] + names]
    for heading, group in figures.overall(evaluation):
        rows.append([heading])
        rows += [_row(figure) for figure in group]
    lines += _aligned(rows)
    if any(result.relative for result in evaluation.results):
        lines += ["", "Relative error over distances (RPE)"]
        lines += _aligned(_relative_rows(evaluation, names))
    if len(names) > 1:
        lines += ["", "* best"]
    return "\n".join(lines) + "\n"


def _heading(evaluation):
    truth = evaluation.truth
    return ["ground truth  %s: %d poses, %.2f s, %.2f m"
            % (evaluation.source, len(truth), truth.duration, evaluation.path_length),
            "alignment     %s" % evaluation.settings.align, ""]


def _marked(figure, index):
    return figure.text(index) + ("*" if index == figure.best else " ")


def _row(figure):
    unit = "[%s]" % figure.unit if figure.unit else ""
    cells = [_marked(figure, index) for index in range(len(figure.values))]
    return ["  " + figure.label, unit] + cells


def _relative_rows(evaluation, names):
    groups = figures.over_distances(evaluation)
    columns = groups[0][1]
    rows = [["distance", "estimate"] + [figure.label for figure in columns],
            ["[m]", ""] + ["[%s]" % figure.unit if figure.unit else "" for figure in columns]]
    for distance, group in groups:
        for index, name in enumerate(names):
            label = "%g" % distance if index == 0 else ""
            rows.append([label, name] + [_marked(figure, index) for figure in group])
    return rows


def _aligned(rows):
    """Rows of cells as lines: two columns flush left, the others flush right.

    A row of one cell is a heading and takes the room it needs.
    """
    count = max(len(row) for row in rows)
    table = [row for row in rows if len(row) > 1]
    widths = [max(len(row[column]) for row in table) for column in range(count)]
    lines = []
    for row in rows:
        cells = [cell.ljust(width) if column < 2 else cell.rjust(width)
                 for column, (cell, width) in enumerate(zip(row, widths))]
        lines.append(_GAP.join(cells).rstrip())
    return lines
