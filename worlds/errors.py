"""The one error of the worlds."""


class WorldError(ValueError):
    """Bad input to a world. The message says what is wrong, where, and how to mend it.

    It is one line, and what cannot be printed, such as a control character of a label or of the name of a file, is
    written as in Python.
    """

    def __str__(self) -> str:
        text = super().__str__()
        return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in text)
