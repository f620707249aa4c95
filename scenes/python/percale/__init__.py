"""Percale: cloth that drapes over mesh obstacles and never goes through them.

Simulation steps cloth and obstacles made by calls; run, check, plan and load_scene take scene files, or dicts laid out like
them; certify checks meshes. Lengths are in m, masses in kg, y is up. Wrong input raises SceneError, a ValueError.
"""
import warnings as _warnings

from . import _percale
from ._percale import *  # noqa: F403
from ._percale import __version__

__all__ = sorted([*(name for name in dir(_percale) if not name.startswith('_')), 'check'])

for _name in __all__:
    if _name != 'check' and not isinstance(getattr(_percale, _name), type(_percale)):
        getattr(_percale, _name).__module__ = __name__
del _name


def check(*scenes, overrides=None, certify_steps=False):
    """Runs scenes as tests: a RunResult each, whose `passed` and `expectations` tell; writes nothing.

    scenes: Scene, path or dict each; overrides and certify_steps as of run. Raises SceneError for a scene that is wrong.
    """
    return [_percale.run(scene, overrides=overrides, certify_steps=certify_steps) for scene in scenes]


_FORMER = {'DroppedSpans': 'DroppedSubsteps'}  # names of the release before


def __getattr__(name):
    if name not in _FORMER:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    _warnings.warn(f'{name} is called {_FORMER[name]} now; the former name works in this release only', DeprecationWarning, stacklevel=2)
    return globals()[_FORMER[name]]
