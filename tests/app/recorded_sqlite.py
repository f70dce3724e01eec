"""Everything that SQLite writes, syncs and deletes, noted in one journal.

SQLite reaches files through a table of functions, its VFS. The layer here is a copy of the default
VFS whose files note each successful write, truncation and sync, and which notes deletions; all
else is the original. It lasts until the process ends. The index of the write-ahead log (-shm) is
shared memory that SQLite rebuilds after a crash; it is not part of the journal.
"""

import ctypes
import os
from collections.abc import Callable
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_int, c_int64, c_void_p
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

OK = 0


class HiddenSqlite(Exception):
    """This interpreter's SQLite does not let its files be recorded; says why."""


class Wrote(NamedTuple):
    """Bytes were written to a file."""

    file: str
    offset: int
    data: bytes


class Truncated(NamedTuple):
    """A file was cut to a size."""

    file: str
    size: int


class Deleted(NamedTuple):
    """A file was deleted."""

    file: str


class Synced(NamedTuple):
    """Whatever had been done to a file is on disk, its name in the folder included."""

    file: str


Change = Wrote | Truncated | Deleted
Entry = Change | Synced

_Write = CFUNCTYPE(c_int, c_void_p, c_void_p, c_int, c_int64)
_Truncate = CFUNCTYPE(c_int, c_void_p, c_int64)
_Sync = CFUNCTYPE(c_int, c_void_p, c_int)


class _Methods(Structure):
    """sqlite3_io_methods, version 3."""

    _fields_ = [
        ("version", c_int),
        ("close", c_void_p),
        ("read", c_void_p),
        ("write", _Write),
        ("truncate", _Truncate),
        ("sync", _Sync),
        ("others", c_void_p * 13),
    ]


class _File(Structure):
    """sqlite3_file."""

    _fields_ = [("methods", POINTER(_Methods))]


# Names are passed on as pointers: SQLite keeps them, and finds parameters behind their end.
_Open = CFUNCTYPE(c_int, c_void_p, c_void_p, POINTER(_File), c_int, c_void_p)
_Delete = CFUNCTYPE(c_int, c_void_p, c_void_p, c_int)


class _Vfs(Structure):
    """sqlite3_vfs, version 3."""

    _fields_ = [
        ("version", c_int),
        ("file_bytes", c_int),
        ("longest_path", c_int),
        ("next", c_void_p),
        ("name", c_char_p),
        ("data", c_void_p),
        ("open", _Open),
        ("delete", _Delete),
        ("others", c_void_p * 14),
    ]


def sqlite_library() -> ctypes.CDLL:
    """The SQLite that Python's module uses; HiddenSqlite if its functions cannot be reached."""
    try:
        import _sqlite3

        # Without a file of its own the module is part of the interpreter, whose handle is None.
        library = ctypes.CDLL(getattr(_sqlite3, "__file__", None))
        library.sqlite3_vfs_find.restype = POINTER(_Vfs)
        library.sqlite3_vfs_register.argtypes = [c_void_p, c_int]
    except (ImportError, OSError, AttributeError) as error:
        raise HiddenSqlite(f"the functions of Python's SQLite are hidden: {error}") from error
    return library


def record_sqlite(note: Callable[[Entry], None]) -> None:
    """Have everything noted that SQLite does to the files it opens from now on."""
    library = sqlite_library()
    original = library.sqlite3_vfs_find(None).contents
    recorder = _Recorder(original, note)
    vfs = _Vfs.from_buffer_copy(original)
    vfs.name, vfs.open, vfs.delete = b"recorded", _Open(recorder.open), _Delete(recorder.delete)
    _for_sqlite.extend([recorder, vfs])
    if library.sqlite3_vfs_register(ctypes.addressof(vfs), 1) != OK:
        raise HiddenSqlite("SQLite took no other way to its files")


_for_sqlite: list[Any] = []
"""What SQLite has pointers to."""


class _Recorder:
    """The functions that note what the original ones have done."""

    def __init__(self, original: _Vfs, note: Callable[[Entry], None]) -> None:
        self._original = original
        self._note = note
        self._names: dict[int, str] = {}
        self._recording: dict[int, _Methods] = {}

    def open(self, _vfs: int, name: int | None, file: Any, flags: int, flags_out: int) -> int:
        """Open a file as always; temporary ones, which have no name, are not recorded."""
        original = ctypes.addressof(self._original)
        result: int = self._original.open(original, name, file, flags, flags_out)
        if result == OK and name:
            self._names[ctypes.addressof(file.contents)] = _name_at(name)
            methods = self._methods(file.contents.methods.contents)
            file.contents.methods = ctypes.pointer(methods)
        return result

    def delete(self, _vfs: int, name: int, sync_folder: int) -> int:
        original = ctypes.addressof(self._original)
        result: int = self._original.delete(original, name, sync_folder)
        if result == OK:
            self._note(Deleted(_name_at(name)))
            if sync_folder:
                self._note(Synced(_name_at(name)))
        return result

    def _methods(self, original: _Methods) -> _Methods:
        """The functions of a kind of file, those that change it being ours."""
        kind = ctypes.addressof(original)
        if kind not in self._recording:
            methods = _Methods.from_buffer_copy(original)
            methods.write = _Write(partial(self._write, original))
            methods.truncate = _Truncate(partial(self._truncate, original))
            methods.sync = _Sync(partial(self._sync, original))
            self._recording[kind] = methods
        return self._recording[kind]

    def _write(self, original: _Methods, file: int, data: int, size: int, offset: int) -> int:
        result: int = original.write(file, data, size, offset)
        if result == OK:
            self._note(Wrote(self._names[file], offset, ctypes.string_at(data, size)))
        return result

    def _truncate(self, original: _Methods, file: int, size: int) -> int:
        result: int = original.truncate(file, size)
        if result == OK:
            self._note(Truncated(self._names[file], size))
        return result

    def _sync(self, original: _Methods, file: int, flags: int) -> int:
        result: int = original.sync(file, flags)
        if result == OK:
            self._note(Synced(self._names[file]))
        return result


def _name_at(address: int) -> str:
    return Path(os.fsdecode(ctypes.string_at(address))).name
