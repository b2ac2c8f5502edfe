"""How one semi-infinite program is solved: on few points, then by Newton's method on the exact active set."""
