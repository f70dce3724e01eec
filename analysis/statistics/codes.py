"""Codes of the warnings that results carry; what they mean to a reader is the report's to say."""

CONSTANT_OUTCOME = "constant_outcome"
DEGENERATE_MARGIN = "degenerate_margin"
TOO_FEW_VALUES = "too_few_values"
