"""JSON Schemas of the scenario file, one per section; opened with `importlib.resources`."""
