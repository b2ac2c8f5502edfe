"""Files that come in: read whole, bounded and checked before anything is made of them."""
