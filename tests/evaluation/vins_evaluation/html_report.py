"""The results as one HTML page that needs nothing from elsewhere."""

import html
import os

from vins_evaluation import figures, plots, style

_ALIGNMENTS = {
    "none": "none: estimates as they are",
    "posyaw": "posyaw: each estimate moved by the translation and the yaw that fit best",
    "se3": "se3: each estimate moved by the translation and the rotation that fit best",
    "sim3": "sim3: each estimate moved and scaled by the similarity that fits best",
}

_DEFINITIONS = (
    "ATE: distance between the aligned estimate and the ground truth, which is "
    "interpolated at the estimate&#8217;s stamps. "
    "Yaw and tilt: parts of the rotation error about the vertical and of the direction of "
    "gravity. Scale error: positive where the estimate is too large, whatever the "
    "alignment. Relative error (RPE): error at the end of every sub-trajectory of the "
    "given length, laid onto the ground truth by its first pose. Completeness: share of "
    "the ground truth&#8217;s time between estimated poses at most %g&nbsp;s apart.")


def html_report(evaluation, command):
    """The page.

    Args:
        evaluation: Evaluation.
        command: the command line as the user typed it.
    """
    has_relative = any(result.relative for result in evaluation.results)
    parts = [_head(evaluation), _overall_table(evaluation), _paths(evaluation),
             _over_time(evaluation)]
    if has_relative:
        parts += [_relative_table(evaluation), _relative_plot(evaluation)]
    parts.append(_footer(evaluation, command))
    return ('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            "<title>Trajectory evaluation: %s</title>\n<style>\n%s</style>\n</head>\n"
            "<body>\n%s\n</body>\n</html>\n"
            % (html.escape(evaluation.source), _style(), "\n".join(parts)))


def _style():
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "report.css")
    with open(path, encoding="utf-8") as file:
        return file.read()


def _head(evaluation):
    truth = evaluation.truth
    return ("<header>\n<h1>Trajectory evaluation</h1>\n"
            "<p>Ground truth <strong>%s</strong>: %.1f&nbsp;s, %.1f&nbsp;m, %d poses</p>\n"
            '<p class="soft">Alignment %s</p>\n</header>\n%s'
            % (html.escape(evaluation.source), truth.duration, evaluation.path_length,
               len(truth), _ALIGNMENTS[evaluation.settings.align], _legend(evaluation)))


def _legend(evaluation):
    entries = ["<span>%sground truth</span>" % _swatch(style.TRUTH_COLOUR)]
    entries += ["<span>%s</span>" % _name(evaluation, index)
                for index in range(len(evaluation.results))]
    return '<div class="legend">%s</div>' % "".join(entries)


def _swatch(colour):
    return '<span class="swatch" style="background:%s"></span>' % colour


def _name(evaluation, index):
    return _swatch(style.colour(index)) + html.escape(evaluation.results[index].name)


def _value(figure, index):
    best = ' class="best"' if index == figure.best else ""
    return "<td%s>%s</td>" % (best, figure.text(index))


def _overall_table(evaluation):
    count = len(evaluation.results)
    names = "".join("<th>%s</th>" % _name(evaluation, index) for index in range(count))
    rows = []
    for heading, group in figures.overall(evaluation):
        rows.append('<tr class="group"><th colspan="%d">%s</th></tr>' % (count + 2, heading))
        rows += [_overall_row(figure) for figure in group]
    return _table('<tr><th class="label"></th><th></th>%s</tr>' % names, rows, "overall")


def _overall_row(figure):
    values = "".join(_value(figure, index) for index in range(len(figure.values)))
    return ('<tr><th class="label">%s</th><td class="unit">%s</td>%s</tr>'
            % (figure.label, figure.unit, values))


def _table(head, rows, kind):
    return ('<div class="scroll"><table class="%s">\n<thead>%s</thead>\n<tbody>\n%s\n</tbody>\n'
            "</table></div>" % (kind, head, "\n".join(rows)))


def _relative_table(evaluation):
    groups = figures.over_distances(evaluation)
    head = "".join("<th>%s<br>%s</th>" % (figure.label, figure.unit or "&nbsp;")
                   for figure in groups[0][1])
    rows = [_relative_row(evaluation, distance, group, index)
            for distance, group in groups for index in range(len(evaluation.results))]
    head = '<tr><th class="label">length</th><th class="label">estimate</th>%s</tr>' % head
    return "<h2>Relative error over distances</h2>\n" + _table(head, rows, "relative")


def _relative_row(evaluation, distance, group, index):
    length = "%g&nbsp;m" % distance if index == 0 else ""
    return ('<tr%s><th class="label">%s</th><td class="label">%s</td>%s</tr>'
            % (' class="first"' if index == 0 else "", length, _name(evaluation, index),
               "".join(_value(figure, index) for figure in group)))


def _paths(evaluation):
    return ('<div class="views">\n%s\n%s\n</div>' % (
        _figure("Top view", "x and y; disc: start, square: end", plots.top_view(evaluation)),
        _figure("Side view", "x and z", plots.side_view(evaluation))))


def _over_time(evaluation):
    return "\n".join([
        _figure("Position error over time", "", plots.position_error(evaluation)),
        _figure("Errors by axis and in yaw", "estimate minus ground truth",
                plots.component_errors(evaluation))])


def _relative_plot(evaluation):
    note = "box: quartiles and median; whiskers: 5th and 95th percentile"
    return _figure("Spread of the relative error", note, plots.relative_errors(evaluation))


def _figure(caption, note, svg):
    return ("<figure>\n<figcaption>%s <span>%s</span></figcaption>\n%s\n</figure>"
            % (caption, note, svg))


def _footer(evaluation, command):
    definitions = _DEFINITIONS % evaluation.settings.max_gap
    return ("<footer>\n<p>%s</p>\n<p>Made by <code>%s</code></p>\n</footer>"
            % (definitions, html.escape(command)))
