"""The one error of the library folders."""


class CogmapError(ValueError):
    """Bad input to the library. The message says what is wrong, where, and how to mend it.

    It is one line, and what cannot be printed, such as a control character of a label or of the name of a file, is
    written as in Python.
    """

    def __str__(self) -> str:
        return printable(super().__str__())


def printable(text: str) -> str:
    """The text with every sign that cannot be printed, or that a terminal would obey, written as in Python."""
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in text)
