"""Decision science: mazes, MDPs, legible policies, observers, rollouts, stimuli.

The names are listed in `__init__.pyi` and load on first use, so that reading the pool of stimuli
or asking for `--help` loads no numerical library.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
