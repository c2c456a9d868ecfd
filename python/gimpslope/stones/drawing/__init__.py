"""Random stones: sizes by a law, shapes, and places that keep their distance."""
