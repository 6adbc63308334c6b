"""What the arithmetic runs on: two processors may round the last digit differently, and then searches part."""

from __future__ import annotations

import functools
import platform

import numpy as np
from threadpoolctl import threadpool_info


@functools.cache
def processor_in_use() -> str:
    """Return the machine, NumPy's largest instruction set there and the kernels of linear algebra.

    Such as ``x86_64, X86_V3, openblas Haswell``: with other instructions or kernels digits may differ. What a library
    does not tell (MKL's kernels, Accelerate) is not in the text.
    """
    found = np.show_config(mode="dicts").get("SIMD Extensions", {}).get("found", [])
    blas = {
        f"{library['internal_api']} {library.get('architecture', '')}".strip()
        for library in threadpool_info()
        if library["user_api"] == "blas"
    }
    return ", ".join([platform.machine(), *found[-1:], *sorted(blas)])
