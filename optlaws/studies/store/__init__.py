"""Where the rows of a study are kept while it runs and after."""
