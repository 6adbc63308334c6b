"""The record of a run: in memory, as CSV files, and as a locked folder."""
