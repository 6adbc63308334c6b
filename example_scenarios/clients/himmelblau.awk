# Himmelblau's function of the variables x and y; its four minima are 0.
BEGIN {
    printf "evaluating x = %s, y = %s\n", x, y > "/dev/stderr"
    printf "{\"value\": %.17g}\n", (x ^ 2 + y - 11) ^ 2 + (x + y ^ 2 - 7) ^ 2
}
