"""The interactive page: one HTML file with all that it shows, readable without its script."""
