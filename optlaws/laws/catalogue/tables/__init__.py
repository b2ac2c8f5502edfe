"""Tables of points: columns of text, and the layouts of controllers."""
