"""Pictures one after the other into a film: MP4 by ffmpeg, GIF and WebP by Pillow."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.system.extras import needed

Picture = NDArray[np.uint8]
"""Red, green and blue, shape [height, width, 3]."""

Take = Callable[[Picture], None]

QUALITY = 23
"""Of MP4, as x264 has it: 0 loses nothing, 23 is its own choice."""

WEBP_QUALITY = 80
"""Of WebP, in per cent."""

LEAST_DELAY = 20
"""Between pictures of a GIF [ms]: browsers take shorter ones for a tenth of a second."""


@contextmanager
def encoder(file: Path, size: tuple[int, int], rate: float) -> Iterator[Take]:
    """Give a function that takes the pictures of a film one after the other.

    Parameters
    ----------
    file
        What to write: ``.mp4``, ``.gif`` or ``.webp``.
    size
        Width and height of the pictures, even numbers.
    rate
        Pictures per second.

    Raises
    ------
    InputError
        The file has another ending, or what writes it is not installed.
    """
    with _WAYS[ending(file)](file, size, rate) as take:
        yield take


def ending(file: Path) -> str:
    """Return the ending of a film's file.

    Raises
    ------
    InputError
        It is none of a film.
    """
    found = file.suffix.lower()
    if found not in _WAYS:
        raise InputError(f"--out {file}: must end in .mp4, .gif or .webp")
    return found


@contextmanager
def _mp4(file: Path, size: tuple[int, int], rate: float) -> Iterator[Take]:
    ffmpeg = needed("imageio_ffmpeg", of=f"--out {file}", extra="film")
    writer = ffmpeg.write_frames(
        str(file),
        size,
        fps=rate,
        codec="libx264",
        quality=None,
        macro_block_size=2,
        output_params=["-crf", str(QUALITY), "-preset", "veryfast", "-movflags", "+faststart"],
        ffmpeg_log_level="error",
    )
    writer.send(None)
    try:
        yield lambda picture: writer.send(np.ascontiguousarray(picture))
    finally:
        writer.close()


@contextmanager
def _gif(file: Path, size: tuple[int, int], rate: float) -> Iterator[Take]:
    from PIL import Image  # noqa: PLC0415 (matplotlib's; not needed by other films)

    del size
    pictures: list[Picture] = []
    yield pictures.append
    # One palette for all, or colours that do not change would flicker.
    sample = np.concatenate(pictures[:: max(1, len(pictures) // 8)])
    palette = Image.fromarray(sample).quantize(256, dither=Image.Dither.NONE)
    first, *others = (
        Image.fromarray(each).quantize(palette=palette, dither=Image.Dither.NONE)
        for each in pictures
    )
    first.save(
        file,
        save_all=True,
        append_images=others,
        duration=_delays(len(pictures), rate, unit=10, least=LEAST_DELAY),
        loop=0,
        optimize=False,
        disposal=1,
    )


@contextmanager
def _webp(file: Path, size: tuple[int, int], rate: float) -> Iterator[Take]:
    from PIL import Image  # noqa: PLC0415

    del size
    pictures: list[Image.Image] = []
    yield lambda picture: pictures.append(Image.fromarray(picture))
    first, *others = pictures
    first.save(
        file,
        save_all=True,
        append_images=others,
        duration=_delays(len(pictures), rate, unit=1, least=1),
        loop=0,
        quality=WEBP_QUALITY,
        method=4,
        allow_mixed=True,  # flat colours without loss
    )


def _delays(count: int, rate: float, *, unit: int, least: int) -> list[int]:
    """Return how long each picture stays [ms], in whole units that add up to the film's length."""
    ends = np.rint(np.arange(count + 1) * 1000.0 / (rate * unit)).astype(int) * unit
    return [max(int(delay), least) for delay in np.diff(ends)]


_WAYS: dict[str, Callable[[Path, tuple[int, int], float], AbstractContextManager[Take]]] = {
    ".mp4": _mp4,
    ".gif": _gif,
    ".webp": _webp,
}
