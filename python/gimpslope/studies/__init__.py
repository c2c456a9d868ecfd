"""Studies made with the package: each a small module over the same interface that users have."""
