"""An explorer in the browser: laws, fronts and cycles that follow the hand, over the library's own functions."""
