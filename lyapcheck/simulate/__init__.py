"""Arms in motion: to set points, along references, at the bench, many at once; performance indices."""
