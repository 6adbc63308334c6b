"""Who may import whom: the one direction in which this project's parts know each other."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

LAYERS = (
    ("errors", "typing"),
    ("quasi_random",),
    ("priors", "objectives", "pareto"),
    ("space",),
    ("evaluation.outcome", "evaluation.placeholders"),
    ("history",),
    ("design", "surrogates", "scalarization"),
    ("acquisition",),
    ("maximizers",),
    ("optimizers",),
    ("scenario",),
    ("evaluation",),
    ("space_assembly",),
    ("assembly",),
    ("starting",),
    ("reports",),
    ("result",),
    ("run", "ask_tell"),
    ("optimizer",),
    ("plotting",),
    ("study",),
    ("cli",),
    ("__main__",),
)
"""Parts of hypermap_lite, lowest first: a module may import from its own part and from layers below it."""

FAMILIES = {"priors", "design", "surrogates", "scalarization", "acquisition", "maximizers", "optimizers"}

NARROWER = {
    "scenario": {"errors", "typing", "objectives", "pareto", "space", "history", "evaluation.placeholders", "scenario"},
    # assembly, scenario, space and priors for the pictures of parameters and priors, which a scenario's text only names
    "plotting": {
        "errors",
        "typing",
        "objectives",
        "pareto",
        "history",
        "plotting",
        "assembly",
        "scenario",
        "space",
        "priors",
    },
}
"""Parts that may know less than their layer allows: scenarios only name components, pictures only read files."""

ONLY_IN = {
    "matplotlib": ("hypermap_lite.plotting",),
    "sklearn": ("hypermap_lite.surrogates",),
    "mujoco": ("robot_tasks",),
    "jsonschema": ("hypermap_lite.scenario.schemas",),
    "referencing": ("hypermap_lite.scenario.schemas",),
    "moocore": ("hypermap_lite.pareto",),
    "cma": ("hypermap_lite.maximizers.evolution_strategy",),
    "rich": ("hypermap_lite.cli",),
    "av": ("robot_tasks.render",),
    "PIL": ("robot_tasks.render",),
    "robot_tasks": ("robot_tasks",),
}
"""Packages and the only places that import them."""

ROBOTS_MAY_IMPORT = ("hypermap_lite.evaluation",)
"""All of hypermap_lite that robot_tasks may know."""

MAY_PRINT = ("hypermap_lite.cli", "hypermap_lite.__main__", "robot_tasks.__main__")

SLOW = ("sklearn", "matplotlib", "mujoco", "pandas", "scipy.stats", "scipy.optimize", "jsonschema", "rich", "cma")
"""What `--help` must not wait for."""


def source_files() -> list[Path]:
    return sorted(p for package in ("hypermap_lite", "robot_tasks") for p in (ROOT / package).rglob("*.py"))


def module_name(file: Path) -> str:
    parts = file.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def is_within(module: str, *packages: str) -> bool:
    return any(module == package or module.startswith(package + ".") for package in packages)


def part_of(module: str) -> str | None:
    """Return the part of hypermap_lite a module belongs to, by its longest name in the layers."""
    inner = module.removeprefix("hypermap_lite").removeprefix(".")
    known = [part for layer in LAYERS for part in layer if is_within(inner, part)]
    return max(known, key=len, default=None)


def layer_of(part: str) -> int:
    return next(i for i, layer in enumerate(LAYERS) if part in layer)


def imports_in(tree: ast.Module, *, at_run_time: bool = False) -> Iterator[tuple[int, str]]:
    """Yield line and absolute module of each import, those for type checkers only where they count."""
    for node in walk(tree, skip_type_checking=at_run_time):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            # a name may itself be a module: `from hypermap_lite.plotting import style`
            yield from ((node.lineno, f"{node.module}.{alias.name}") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.lineno, "." * node.level


def walk(node: ast.AST, *, skip_type_checking: bool) -> Iterator[ast.AST]:
    for child in ast.iter_child_nodes(node):
        if skip_type_checking and isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING":
            continue
        yield child
        yield from walk(child, skip_type_checking=skip_type_checking)


def direction_problem(module: str, imported: str) -> str | None:
    """Say which rule of the layers an import breaks, or return None."""
    if is_within(module, "robot_tasks"):
        is_allowed = not is_within(imported, "hypermap_lite") or is_within(imported, *ROBOTS_MAY_IMPORT)
        return None if is_allowed else f"robot_tasks may import only {', '.join(ROBOTS_MAY_IMPORT)}"
    importer, part = part_of(module), part_of(imported)
    if importer is None or part is None or importer == part:
        return None
    if importer in NARROWER and part not in NARROWER[importer]:
        return f"{importer} may import only {', '.join(sorted(NARROWER[importer]))}"
    below_itself = layer_of(part) < layer_of(importer)
    return None if below_itself else f"{importer} may import only from layers below it, and {part} is not"


def problems(module: str, source: str, file: str) -> list[str]:
    """Return what a file's imports and prints break, each as ``file:line: what: rule``."""
    tree = ast.parse(source)
    found = []
    for line, imported in imports_in(tree):
        if imported.startswith("."):
            found.append(f"{file}:{line}: relative import: names are written in full")
        elif is_within(imported, "hypermap_lite") and (rule := direction_problem(module, imported)):
            found.append(f"{file}:{line}: imports {imported}: {rule}")
    for line, imported in imports_in(tree, at_run_time=True):
        places = ONLY_IN.get(imported.partition(".")[0])
        if places and not is_within(module, *places):
            found.append(f"{file}:{line}: imports {imported}: only {', '.join(places)} may")
    if not is_within(module, *MAY_PRINT):
        prints = [n for n in ast.walk(tree) if isinstance(n, ast.Call) and ast.unparse(n.func) == "print"]
        found += [f"{file}:{node.lineno}: print(): only {', '.join(MAY_PRINT)} may, others log" for node in prints]
    return found


@pytest.mark.parametrize("file", [pytest.param(f, id=str(f.relative_to(ROOT))) for f in source_files()])
def test_file_keeps_the_rules(file):
    found = problems(module_name(file), file.read_text(encoding="utf-8"), str(file.relative_to(ROOT)))
    assert not found, "\n" + "\n".join(found)


def test_every_part_has_its_layer():
    parts = {
        p.stem if p.suffix else p.name for p in (ROOT / "hypermap_lite").iterdir() if not p.name.startswith("__py")
    }
    folders = {p for p in parts if (ROOT / "hypermap_lite" / p).is_dir() or (ROOT / f"hypermap_lite/{p}.py").exists()}
    assert folders - {"__init__"} == {part.partition(".")[0] for layer in LAYERS for part in layer}


def test_families_stay_out_of_the_scenario():
    assert not FAMILIES & NARROWER["scenario"]


@pytest.mark.parametrize(
    ("module", "source", "problem"),
    [
        pytest.param(
            "hypermap_lite.space.real",
            "x = 1\nfrom hypermap_lite.history import history",
            "f.py:2: imports hypermap_lite.history.history: space may import only from layers below it",
            id="upwards",
        ),
        pytest.param(
            "hypermap_lite.scenario.model",
            "import hypermap_lite.priors.beta",
            "f.py:1: imports hypermap_lite.priors.beta: scenario may import only errors,",
            id="scenario to family",
        ),
        pytest.param(
            "hypermap_lite.design.grid",
            "def f():\n    from hypermap_lite import surrogates",
            "f.py:2: imports hypermap_lite.surrogates: design may import only from layers below",
            id="sideways inside a function",
        ),
        pytest.param(
            "hypermap_lite.history.rows",
            "from hypermap_lite.evaluation.runner import Runner",
            "history may import only from layers below it, and evaluation is not",
            id="evaluation is above its outcome",
        ),
        pytest.param("hypermap_lite.run", "import mujoco", "imports mujoco: only robot_tasks may", id="library"),
        pytest.param("hypermap_lite.run", "import robot_tasks", "only robot_tasks may", id="robot"),
        pytest.param(
            "robot_tasks.rollout",
            "from hypermap_lite.space import SearchSpace",
            "robot_tasks may import only hypermap_lite.evaluation",
            id="robot to optimizer",
        ),
        pytest.param("hypermap_lite.run", "print(1)", "f.py:1: print(): only hypermap_lite.cli", id="print"),
        pytest.param("hypermap_lite.run", "from . import errors", "relative import", id="relative"),
    ],
)
def test_rules_catch(module, source, problem):
    (found,) = problems(module, source, "f.py")
    assert problem in found


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("hypermap_lite.history.rows", "from hypermap_lite.evaluation.outcome import State"),
        ("hypermap_lite.history.rows", "from hypermap_lite import __version__"),
        ("hypermap_lite.acquisition.base", "import hypermap_lite.surrogates.base"),
        ("hypermap_lite.scenario.messages", "if TYPE_CHECKING:\n    import jsonschema"),
        ("hypermap_lite.cli.run", "from hypermap_lite.run import Result\nprint(Result)"),
        ("robot_tasks.evaluation", "from hypermap_lite.evaluation.evaluator import Evaluator"),
    ],
)
def test_rules_allow(module, source):
    assert problems(module, source, "f.py") == []


def test_help_does_not_wait_for_slow_libraries():
    code = f"import sys, hypermap_lite.cli; print([name for name in {SLOW} if name in sys.modules])"
    result = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert result.stdout == "[]\n"
