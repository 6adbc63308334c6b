"""HyperMapper's scenario files: translated into our form before anything else looks at them."""

from hypermap_lite.scenario.hypermapper.draft import Note
from hypermap_lite.scenario.hypermapper.fork_keys import KEYS, PARAMETER_KEYS
from hypermap_lite.scenario.hypermapper.reading import is_hypermapper
from hypermap_lite.scenario.hypermapper.translation import Translation, hypermappers_key, translate

__all__ = ["KEYS", "PARAMETER_KEYS", "Note", "Translation", "hypermappers_key", "is_hypermapper", "translate"]
