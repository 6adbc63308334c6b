"""An optimizer that follows a script instead of a model, for tests of programs that speak the client-server protocol.

    python scripted_optimizer.py SCRIPT ANSWERS [SCENARIO]

SCRIPT is a JSON list of what to do in turn: a string is written as a line, a number means that as many lines are read.
What was read goes to ANSWERS, line by line.
"""

import json
import sys
from pathlib import Path


def main() -> None:
    """Do what the script says."""
    steps = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    with Path(sys.argv[2]).open("w", encoding="utf-8") as answers:
        for step in steps:
            if isinstance(step, str):
                print(step, flush=True)
            else:
                answers.writelines(sys.stdin.readline() for _ in range(step))


if __name__ == "__main__":
    main()
