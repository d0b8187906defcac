"""The one kind of error that is the user's to put right."""


class EvaluationError(Exception):
    """Input that cannot be evaluated; the message names the place and the remedy."""
