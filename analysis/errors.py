"""What can go wrong in the analysis.

AnalysisError
├── TableError      a table breaks its contract: file, row, column, expected, got
├── TomlError       a plan or a mapping says what it cannot: file, key, expected, got
└── EmptyArmError   a condition has no value to compare
"""


class AnalysisError(Exception):
    """Base of all errors of this package; the message is one line fit to be shown."""


class TableError(AnalysisError):
    """A table breaks its contract.

    `row` counts as a spreadsheet does (the header of a CSV file is row 1) and is None when the
    whole table or column is meant; `further` is how many more problems were found.
    """

    def __init__(
        self,
        file: str,
        expected: str,
        got: str,
        *,
        row: int | None = None,
        column: str | None = None,
        further: int = 0,
    ) -> None:
        self.file, self.row, self.column = file, row, column
        self.expected, self.got, self.further = expected, got, further
        where = [file]
        if row is not None:
            where.append(f"row {row}")
        if column is not None:
            where.append(f"column {column}")
        more = f" (and {further} more problem{'s' if further > 1 else ''})" if further else ""
        super().__init__(f"{', '.join(where)}: expected {expected}, got {got}{more}")


class TomlError(AnalysisError):
    """A plan or a mapping, written as TOML, cannot be followed.

    `key` is dotted as in the file, and empty when the whole file is meant.
    """

    def __init__(self, file: str, key: str, expected: str, got: str) -> None:
        self.file, self.key, self.expected, self.got = file, key, expected, got
        where = f"{file}, key {key}" if key else file
        super().__init__(f"{where}: expected {expected}, got {got}")


class EmptyArmError(AnalysisError):
    """A condition without any value: there is nothing to compare.

    `arm` is the condition's name, `measure` what was to be compared, `file` where it was looked
    for, empty if that is not known.
    """

    def __init__(self, arm: str, measure: str, note: str = "", file: str = "") -> None:
        self.arm, self.measure, self.file = arm, measure, file
        where = f"{file}, condition {arm}" if file else f"condition {arm}"
        super().__init__(f"{where}: expected at least one {measure}, got none{note}")
