"""A lab's set-up as a short text that one person sends and another pastes.

`ONPATH1-<set-up>-<checksum>`: JSON, deflated, in base 32, so that it survives a chat, a mail and
a telephone. The checksum's length is fixed, so that the code ends where it ends, whatever follows.
"""

from __future__ import annotations

import base64
import re
import zlib

import msgspec

from onpath.app.lab.setup import Setup, from_data, to_data
from onpath.models.errors import CodedError, said_by

VERSION = 1
LONGEST_TEXT = 50_000  # [characters] that are looked at
LARGEST = 20_000  # [B], of a set-up when inflated
_CODE = re.compile(r"ONPATH([0-9]{1,6})-([A-Z2-7]*)-([A-Z2-7]{7})", re.ASCII | re.IGNORECASE)
_BEGINNING = re.compile(r"ONPATH([0-9]{1,6})-", re.ASCII | re.IGNORECASE)
_SPACE = re.compile(r"[\s\u00ad\u200b\ufeff]+")  # with what chats and mails put in to break lines
_encoder = msgspec.json.Encoder(order="sorted")
# What a code need not spell out. Part of the format: another text is another version.
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
    """The set-up in a text that holds a share code, with words around it and breaks inside it.

    Raises:
        ValueError: in words what is wrong with it.
    """
    if len(text) > LONGEST_TEXT:
        raise CodedError("error.share_too_long")
    text = _SPACE.sub("", text)
    beginning, code = _BEGINNING.search(text), _CODE.search(text)
    if beginning is None:
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
    """What follows is for those who made the checksum themselves."""
    try:
        packed = base64.b32decode(body + "=" * (-len(body) % 8))
        inflate = zlib.decompressobj(wbits=-15, zdict=_KNOWN)
        data = inflate.decompress(packed, LARGEST)
        if not inflate.eof or inflate.unused_data:
            raise ValueError("too large")
        plain = msgspec.json.decode(data)
    except (ValueError, RecursionError, zlib.error) as error:
        raise CodedError("error.share_empty") from error
    try:
        return from_data(plain)
    except msgspec.ValidationError as error:  # quotes whatever it met
        raise CodedError("error.share_strange") from error
    except ValueError as error:
        raise CodedError("error.share_does_not_fit", error=said_by(error)) from error


def _base32(data: bytes) -> str:
    return base64.b32encode(data).decode().rstrip("=")


def _checksum(body: str) -> str:
    return _base32(zlib.crc32(f"{VERSION}-{body}".encode()).to_bytes(4, "big"))
