"""Views of the explorer's page: the computation behind each view's requests, a file for each view."""
