"""The plots of a report, one file a figure; each is a pure function from data to SVG text."""
