"""What the extension module names itself."""

import _pitviper

InputError = _pitviper.InputError
__version__: str = _pitviper.version
