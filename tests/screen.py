"""What a browser shows of a live figure, composed as `live.js` does, from what it was sent."""

import zlib

import numpy as np


def shown(screen):
    """The picture: uint8, shape (height, width, 3)."""
    ground, moving = (np.frombuffer(zlib.decompress(sent), "<u4") for sent in (screen.ground, screen.moving))
    steps, colours = np.split(moving, 2)
    pixels = ground.copy()
    pixels[np.cumsum(steps)] = colours
    width, height = screen.size
    return pixels.view(np.uint8).reshape(height, width, 4)[..., :3]
