"""What several tests of pictures need."""

import pytest

from hypermap_lite.plotting import style


@pytest.fixture
def figures(monkeypatch):
    """Figures as they are saved, for a look at what was drawn."""
    saved = []
    save = style.save
    monkeypatch.setattr(style, "save", lambda figure, output: saved.append(figure) or save(figure, output))
    return saved
