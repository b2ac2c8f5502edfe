"""What the explorer's page asks, and what it is answered: every number and every digit comes from here."""
