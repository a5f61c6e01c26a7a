"""What a call has to be refused with."""


def refused(kind, words, call):
    try:
        result = call()
    except kind as error:
        assert words in str(error), f"'{error}' lacks '{words}'"
    else:
        raise AssertionError(f"not refused: {result}")
