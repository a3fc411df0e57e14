"""Share codes: a lab's set-up as a short text to send and paste.

`ONPATH1-<set-up>-<checksum>`: JSON, deflated, in base 32, so that it survives chat, mail and
dictation. The checksum has a fixed length, so that the end of the code is found in any text.
"""

from __future__ import annotations

import base64
import re
import zlib

import msgspec

from onpath.app.common.access_codes import as_meant, is_code
from onpath.app.lab.setups.former import DEFAULTS
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.stored import from_data, to_data
from onpath.models.errors import CodedError, message_of

VERSION = 1
LONGEST_TEXT = 50_000  # maximum input, [characters]
LARGEST = 100_000  # maximum size of an inflated set-up, [B]
_CODE = re.compile(r"ONPATH([0-9]{1,6})-([A-Z2-7]*)-([A-Z2-7]{7})", re.ASCII | re.IGNORECASE)
_BEGINNING = re.compile(r"ONPATH([0-9]{1,6})-", re.ASCII | re.IGNORECASE)
_BETWEEN = re.compile(r"[^A-Za-z0-9-]+")  # what mails insert to break lines, and quotes
_encoder = msgspec.json.Encoder(order="sorted")
# Dictionary for deflate. Part of the format: changing it requires a new version.
_KNOWN = (
    b'"exaggeration":10.0,"rate":0.5,"copy":false,"robot":"flexible","benches":{"flexible":{'
    b'"five_bar":{"parameters":{"across":"level_set","task":"position","target":"law":"redefined",'
    b'"alpha":0.0,"torque_limit":0.5,"encoder_counts":2000.0,"coulomb":0.05,"control_rate":100,'
    b'"payload":0.1,"speed":,"K5":0.0,"K4":,"K3":,"K2":,"K1":},"path":{"closed":false,'
    b'"name":"ellipse"}}}"clover""segment""rounded square","path":{"name":"edited","numbers":['
    b'"drawn","numbers":[0,-1,-2,'
)


def encode(setup: Setup) -> str:
    """The share code of a set-up, the same for the same set-up."""
    squeeze = zlib.compressobj(9, wbits=-15, zdict=_KNOWN)
    packed = squeeze.compress(_encoder.encode(to_data(setup))) + squeeze.flush()
    text = _base32(packed)
    return f"ONPATH{VERSION}-{text}-{_checksum(text)}"


def decode(text: str) -> Setup:
    """Find a share code in a text, with line breaks inside and words around it, and decode it.

    Raises:
        ValueError: the message says what is wrong with the code.
    """
    if len(text) > LONGEST_TEXT:
        raise CodedError("error.share_too_long")
    plain = _BETWEEN.sub("", as_meant(text))
    beginning, code = _BEGINNING.search(plain), _CODE.search(plain)
    if beginning is None:
        if is_code(text):
            raise CodedError("error.share_is_lab")
        raise CodedError("error.share_missing", version=VERSION)
    if int(beginning[1]) > VERSION:
        raise CodedError("error.share_newer")
    if code is None:
        raise CodedError("error.share_incomplete")
    body, checksum = code[2].upper(), code[3].upper()
    if code[1] != str(VERSION) or checksum != _checksum(body):
        raise CodedError("error.share_mistyped")
    return _setup(body)


def _setup(body: str) -> Setup:
    """Decode the body. Its checksum is right, so errors here are from hand-made codes."""
    try:
        packed = base64.b32decode(body + "=" * (-len(body) % 8))
        inflate = zlib.decompressobj(wbits=-15, zdict=_KNOWN)
        data = inflate.decompress(packed, LARGEST)
        if not inflate.eof or inflate.unused_data:
            raise ValueError("too large")
        plain = msgspec.json.decode(data)
    except (ValueError, RecursionError, zlib.error) as error:
        raise CodedError("error.share_empty") from error
    defaults = plain.get("defaults", 0) if isinstance(plain, dict) else 0
    if isinstance(defaults, int) and defaults > DEFAULTS:
        raise CodedError("error.share_newer")
    try:
        return from_data(plain)
    except msgspec.ValidationError as error:  # its message quotes the data
        raise CodedError("error.share_strange") from error
    except ValueError as error:
        raise CodedError("error.share_does_not_fit", error=message_of(error)) from error


def _base32(data: bytes) -> str:
    return base64.b32encode(data).decode().rstrip("=")


def _checksum(body: str) -> str:
    return _base32(zlib.crc32(f"{VERSION}-{body}".encode()).to_bytes(4, "big"))
