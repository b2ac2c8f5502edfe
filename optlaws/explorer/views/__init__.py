"""Views of the explorer's page: what each computes for its questions, a file a view."""
