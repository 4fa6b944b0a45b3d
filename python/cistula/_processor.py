"""Whether this processor and this interpreter run the module: before it is loaded, since nothing can be said once it is."""
from __future__ import annotations

import importlib

_NEEDED = ("avx", "avx2", "fma", "bmi1", "bmi2", "f16c", "movbe", "abm")


def lacking(cpuinfo: str) -> list[str]:
    """The needed features that the text of /proc/cpuinfo does not name."""
    flags = next((line.split() for line in cpuinfo.splitlines() if line.startswith("flags")), None)
    return [] if flags is None else [name.upper() for name in _NEEDED if name not in flags]


def require_processor() -> None:
    """Raises ImportError where the processor is older than x86-64-v3."""
    try:
        with open("/proc/cpuinfo") as file:
            lacks = lacking(file.read(8192))
    except OSError:
        return
    if lacks:
        raise ImportError(f"cistula: this processor lacks {', '.join(lacks)}; x86-64-v3 is needed (Intel Haswell of 2013, AMD "
                          "Excavator or Zen, or later)")


def require_main_interpreter() -> None:
    """Raises ImportError in a subinterpreter: a process has the module once."""
    for name in ("_interpreters", "_xxsubinterpreters"):  # of CPython 3.13, and of those before
        try:
            interpreters = importlib.import_module(name)
        except ImportError:
            continue
        if interpreters.get_current() != interpreters.get_main():
            raise ImportError("cistula: this is a subinterpreter; import it in the main interpreter, or in processes of their own")
        return
