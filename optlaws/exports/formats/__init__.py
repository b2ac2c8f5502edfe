"""Formats of controllers: in languages of IEC 61131-3, as text without a language, and as programs."""
