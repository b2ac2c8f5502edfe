"""Values that declare their entries once, from which constructors, files, errors, forms and references are made."""
