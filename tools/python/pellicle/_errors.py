"""What goes wrong in the engine, as exceptions."""


class PellicleError(Exception):
    """Base of the errors of the engine."""


class InvalidArgument(PellicleError, ValueError):
    """A parameter is outside its range."""


class InvalidData(PellicleError, ValueError):
    """The image or mesh cannot be used."""


class OutOfMemory(PellicleError, MemoryError):
    """There is no more memory, or the context's limit has been reached."""


class Cancelled(PellicleError):
    """For callbacks: raise it, or any other exception, to stop the call that they are made in."""


class InternalError(PellicleError, RuntimeError):
    """A bug of the engine, caught before it did harm."""
