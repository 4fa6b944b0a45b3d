"""The explorer in a notebook: the page's script and style as a widget, which asks the kernel for any pixel."""
from __future__ import annotations

from typing import Any

from . import _core


def widget(image: _core.Image, start: str) -> Any:
    """The widget of an image; start: what its script begins with. Raises ImportError without anywidget."""
    try:
        import anywidget
        import traitlets
    except ImportError as error:
        raise ImportError("Image.explore() shows a widget, which needs anywidget: pip install 'cistula[notebooks]'; "
                          "Image.explore(\"page.html\") writes a page without it") from error

    def answer(shown: Any, asked: dict[str, int], _buffers: object) -> None:
        x, y = asked["x"], asked["y"]
        try:
            shown.send({"x": x, "y": y, "rays": image._explorer_rays(x, y)})
        except Exception as error:  # told where the pixel was asked for
            shown.send({"x": x, "y": y, "error": str(error)})

    traits = {"_esm": _core.explorer_script, "_css": _core.explorer_style, "start": traitlets.Unicode(start).tag(sync=True)}
    shown = type("Explorer", (anywidget.AnyWidget,), traits)()
    shown.on_msg(answer)
    return shown
