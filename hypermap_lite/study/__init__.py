"""Studies: variants of an experiment, each run several times, and compared.

`specification` reads the file, `running` makes the runs that are missing, each by a `job`, `summary` compares all runs
with the arithmetic of `statistics`, and `tables` writes that down.
"""

from hypermap_lite.study.running import run_study
from hypermap_lite.study.specification import Study, Variant, load_study
from hypermap_lite.study.summary import summarize
from hypermap_lite.study.tables import write_tables

__all__ = ["Study", "Variant", "load_study", "run_study", "summarize", "write_tables"]
