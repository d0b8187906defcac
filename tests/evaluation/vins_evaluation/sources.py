"""What an argument on the command line means: a file, a folder, a bag's topic."""

import collections
import os
import re

from vins_evaluation import bag_topics, trajectory_files
from vins_evaluation.errors import EvaluationError

_ASL_FILE = os.path.join("state_groundtruth_estimate0", "data.csv")
_BAG_TOPIC = re.compile(r"(?P<bag>.+\.bag)(:(?P<topic>.*))?")

LoadedTrajectory = collections.namedtuple("LoadedTrajectory",
                                          "source trajectory warnings")


def load(source):
    """Load what the user typed.

    Args:
        source: a TUM or csv file, an EuRoC ASL folder (or its mav0), or
            FILE.bag:/topic.
    Returns:
        a LoadedTrajectory.
    Raises:
        EvaluationError.
    """
    bag = _BAG_TOPIC.fullmatch(source)
    if bag:
        topic = bag.group("topic") or ""
        return LoadedTrajectory(source, *bag_topics.read_bag_topic(bag.group("bag"), topic))
    path = _asl_ground_truth(source) if os.path.isdir(source) else source
    return LoadedTrajectory(source, *trajectory_files.read_trajectory_file(path))


def _asl_ground_truth(folder):
    candidates = [os.path.join(folder, "mav0", _ASL_FILE), os.path.join(folder, _ASL_FILE)]
    for path in candidates:
        if os.path.isfile(path):
            return path
    raise EvaluationError("%s: a folder without EuRoC ground truth: neither %s nor %s exists"
                          % (folder, candidates[0], candidates[1]))


def short_names(sources):
    """Short, distinct display names for what the user typed.

    A file's name without folder and ending; where two are alike, both as typed.
    """
    shorts = [_short_name(source) for source in sources]
    names = [source if shorts.count(short) > 1 else short
             for source, short in zip(sources, shorts)]
    return ["%s (%d)" % (name, names[:index].count(name) + 1) if names.count(name) > 1
            else name for index, name in enumerate(names)]


def _short_name(source):
    bag = _BAG_TOPIC.fullmatch(source)
    if bag:
        stem = os.path.splitext(os.path.basename(bag.group("bag")))[0]
        return "%s:%s" % (stem, bag.group("topic") or "")
    return os.path.splitext(os.path.basename(os.path.normpath(source)))[0]
