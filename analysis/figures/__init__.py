"""The figures of the report: functions of plain frames and results, each returning a `Drawn`."""

from .accuracy import figure_accuracy_by_time, figure_calibration
from .drawn import Drawn, write_figure
from .flow import figure_flow
from .forest import figure_forest
from .incidence import figure_incidence
from .paper import figure_confidence, figure_correct, figure_prediction_time
from .rain import figure_raincloud
from .scales import CONFIDENCE, CORRECT, PREDICTION_TIME, STOP_TIME, Scale, confidence_scale
from .slopes import figure_slopes
from .stacked import figure_confidence_levels
from .style import COLOURS, Labels

__all__ = [
    "COLOURS",
    "CONFIDENCE",
    "CORRECT",
    "PREDICTION_TIME",
    "STOP_TIME",
    "Drawn",
    "Labels",
    "Scale",
    "confidence_scale",
    "figure_accuracy_by_time",
    "figure_calibration",
    "figure_confidence",
    "figure_confidence_levels",
    "figure_correct",
    "figure_flow",
    "figure_forest",
    "figure_incidence",
    "figure_prediction_time",
    "figure_raincloud",
    "figure_slopes",
    "write_figure",
]
