"""Statistics of the study: the export's contract, the measures, the tests, the report.

Public names load on first use: `from analysis import score` reads one small file, and neither
polars nor scipy nor matplotlib.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
