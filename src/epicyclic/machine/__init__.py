"""A machine of elements: bodies, meshes that couple their speeds, and what loses power."""
