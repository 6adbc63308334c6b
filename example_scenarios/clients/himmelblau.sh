#!/bin/sh
# Himmelblau's function by files: reads the parameters from one JSON file, writes the result to another.
# usage: himmelblau.sh PARAMS_FILE RESULT_FILE
set -eu

value_of() { # the number of a key in a flat JSON object
    tr -d ' \n{}' <"$1" | tr ',' '\n' | sed -n "s/^\"$2\"://p"
}

x=$(value_of "$1" x)
y=$(value_of "$1" y)
awk -v "x=$x" -v "y=$y" -f himmelblau.awk >"$2"
