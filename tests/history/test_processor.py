"""The processor is named by what decides how it rounds."""

import platform

from hypermap_lite.history.processor import processor_in_use


def test_machine_instructions_and_kernels_are_named(monkeypatch):
    library = {"user_api": "blas", "internal_api": "openblas", "architecture": "Haswell"}
    others = [{"user_api": "blas", "internal_api": "mkl"}, {"user_api": "openmp", "internal_api": "openmp"}]
    monkeypatch.setattr("hypermap_lite.history.processor.threadpool_info", lambda: [library, library, *others])
    extensions = {"SIMD Extensions": {"found": ["AVX", "AVX2"]}}
    monkeypatch.setattr("hypermap_lite.history.processor.np.show_config", lambda mode: extensions)
    assert processor_in_use.__wrapped__() == f"{platform.machine()}, AVX2, mkl, openblas Haswell"


def test_what_is_not_known_is_left_out(monkeypatch):
    monkeypatch.setattr("hypermap_lite.history.processor.threadpool_info", list)
    monkeypatch.setattr("hypermap_lite.history.processor.np.show_config", lambda mode: {})
    assert processor_in_use.__wrapped__() == platform.machine()
