# SPDX-License-Identifier: MIT
# The extension: src/fit.c. Its calls are for _fits.py alone.
from typing import Any

def __getattr__(name: str) -> Any: ...
