"""The black box: how it is called, what it answers, and the loop that drives it."""
