"""Matplotlib figures as SVG that can stand inside an HTML page."""

import io
import re

from matplotlib.backends.backend_svg import FigureCanvasSVG

_HEAD = re.compile(r"^.*?(?=<svg)", re.DOTALL)
_DEAD_WEIGHT = re.compile(r"<!--.*?-->\s*|<metadata>.*?</metadata>\s*", re.DOTALL)
# An HTML parser knows SVG's namespaces; as attributes they would look like links.
_NAMESPACES = re.compile(r'\s+xmlns(:\w+)?="[^"]*"')
_SIZE = re.compile(r'\s+(width|height)="[\d.]+pt"')
_PATH_DATA = re.compile(r'(?<= d=")[^"]*')
_LONG_DECIMALS = re.compile(r"-?\d+\.\d{3,}")
_REFERENCES = re.compile(r'(?<=href="#)[^"]+|(?<=url\(#)[^)]+')
_IDS = re.compile(r' id="([^"]*)"')


def inline_svg(figure, prefix, title):
    """A figure as an <svg> element that fills the width it is given.

    Args:
        figure: matplotlib.figure.Figure.
        prefix: makes the element's ids unique in the page.
        title: what a screen reader says.
    """
    buffer = io.StringIO()
    FigureCanvasSVG(figure).print_svg(buffer)
    text = _DEAD_WEIGHT.sub("", _HEAD.sub("", buffer.getvalue()))
    text = _SIZE.sub("", _NAMESPACES.sub("", text), count=2)
    text = _PATH_DATA.sub(_rounded, text)
    text = _with_own_ids(text, prefix)
    return text.replace("<svg", '<svg role="img" aria-label="%s"' % title, 1)


def _rounded(path_data):
    """Path data to a hundredth of a point, on one line: half of the bytes."""
    short = _LONG_DECIMALS.sub(lambda number: "%.2f" % float(number.group()),
                               path_data.group())
    return " ".join(short.split())


def _with_own_ids(text, prefix):
    """Keep the ids that something refers to, with a prefix; drop the others."""
    used = set(_REFERENCES.findall(text))

    def own(match):
        return ' id="%s-%s"' % (prefix, match.group(1)) if match.group(1) in used else ""

    text = _IDS.sub(own, text)
    return _REFERENCES.sub(lambda match: "%s-%s" % (prefix, match.group()), text)
