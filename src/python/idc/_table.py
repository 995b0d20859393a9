"""Tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from idc import _idc

if TYPE_CHECKING:
    import pandas


class Table:
    """A table in memory, its columns named with their units.

    It is handed over by Arrow's PyCapsule interface: `pyarrow.table(t)` and `polars.DataFrame(t)` take it as it is, without a copy of its values.
    """

    __slots__ = ("_inner",)

    def __init__(self, inner: _idc.Table) -> None:
        self._inner = inner

    @property
    def columns(self) -> list[str]:
        """Names of its columns, units included: `contact_force_n` in N."""
        return self._inner.columns

    def __len__(self) -> int:
        return len(self._inner)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self._inner.__arrow_c_stream__(requested_schema)

    def to_arrow(self) -> Any:
        """It as a table of pyarrow."""
        return _pyarrow().table(self)

    def to_pandas(self) -> pandas.DataFrame:
        """It as a data frame of pandas; names as categories."""
        try:
            import pandas  # noqa: F401
        except ImportError as absent:
            raise _absent("pandas") from absent
        frame: pandas.DataFrame = _pyarrow().table(self).to_pandas()
        return frame

    def _repr_html_(self) -> str:
        """Its first and last rows, where pandas is installed."""
        try:
            frame = self.to_pandas()
        except ImportError:
            return f"<p>{self!r}</p>"
        return frame.to_html(max_rows=10, max_cols=12)

    def __repr__(self) -> str:
        return f"<idc.Table of {len(self)} rows and {len(self.columns)} columns>"


def _absent(name: str) -> ImportError:
    return ImportError(f"{name} is not installed, and to_pandas() needs it: pip install 'idc[pandas]'", name=name)


def _pyarrow() -> Any:
    try:
        import pyarrow  # type: ignore[import-untyped, unused-ignore]
    except ImportError as absent:
        raise _absent("pyarrow") from absent
    return pyarrow
