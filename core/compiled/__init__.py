"""numba's `njit`, whose compiled code is kept on disk only as long as nothing that was compiled into it has changed.

numba itself looks no further than the file that holds the function. A function inlined from another file and a constant
of another module are part of the machine code too: after a change of theirs numba would go on with the old code. Here
the code is kept under a hash of the function, of all that it calls and of every value that it refers to.
"""

from .beside import compile_beside
from .decorator import njit
from .hashes import compiled_hash

__all__ = ["compile_beside", "compiled_hash", "njit"]
