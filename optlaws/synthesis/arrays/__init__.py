"""Many problems that differ in numbers alone, solved together: states, rows, cells and bounds as stacks of arrays."""
