"""How all plots look."""

# Okabe and Ito, "Color universal design", 2008, without black and yellow.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
TRUTH_COLOUR = "#555555"

# For matplotlib.rc_context.
STYLE = {
    "font.size": 9,
    "axes.edgecolor": "#888888",
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.1,
    "lines.solid_joinstyle": "round",
    "path.simplify": True,
    "path.simplify_threshold": 0.15,
    "svg.fonttype": "none",
    # Without a salt the ids, and so the file, would differ from run to run.
    "svg.hashsalt": "evaluate_trajectory",
    "xtick.color": "#555555",
    "ytick.color": "#555555",
}


def colour(index):
    """The colour of estimate number index."""
    return COLOURS[index % len(COLOURS)]
