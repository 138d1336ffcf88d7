"""The text of a room file: strict YAML, checked against its schema.

YAML is read as people mean it: a repeated key, an alias or a number that is not finite
is refused, and only `true` and `false` are booleans, so that the key `on` stays a word.
Every complaint is one line that names file, field, value and what was expected.
"""

import math
import re
from collections.abc import Hashable
from pathlib import Path
from typing import Any

import yaml

from placing.errors import BadInput
from placing.schema import check

MAX_BYTES = 1_000_000
"""Guards the parser: a room with five arrangements has about 15,000."""

MAX_DEPTH = 20
"""Guards the parser, which calls itself for each level of nesting."""

BOOL = "tag:yaml.org,2002:bool"


class StrictLoader(yaml.SafeLoader):
    """Loads YAML safely, without repeated keys, aliases and infinite numbers."""

    depth = 0
    yaml_implicit_resolvers = {  # noqa: RUF012  PyYAML declares it without ClassVar.
        first: [pair for pair in pairs if pair[0] != BOOL]
        for first, pairs in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def compose_node(self, parent: Any, index: Any) -> Any:  # noqa: ANN401
        """Return the next node unless it is an alias or too deep."""
        mark = self.peek_event().start_mark
        if self.check_event(yaml.AliasEvent):
            raise yaml.MarkedYAMLError(None, None, "an alias is not allowed", mark)
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise yaml.MarkedYAMLError(None, None, "is nested too deeply", mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def construct_mapping(
        self, node: yaml.MappingNode, deep: bool = False
    ) -> dict[Hashable, Any]:
        """Return the mapping of a node whose keys all differ."""
        keys = [self.construct_object(key, deep=True) for key, _ in node.value]
        repeated = [key for key in keys if keys.count(key) > 1]
        if repeated:
            problem = f"key {repeated[0]!r} is given twice"
            raise yaml.MarkedYAMLError(None, None, problem, node.start_mark)
        return super().construct_mapping(node, deep)

    def construct_yaml_float(self, node: yaml.ScalarNode) -> float:
        """Return the number of a node if it is finite."""
        value = super().construct_yaml_float(node)
        if not math.isfinite(value):
            problem = f"{node.value} is not a finite number"
            raise yaml.MarkedYAMLError(None, None, problem, node.start_mark)
        return value


StrictLoader.add_constructor(
    "tag:yaml.org,2002:float", StrictLoader.construct_yaml_float
)
StrictLoader.add_implicit_resolver(BOOL, re.compile("^(true|false)$"), list("tf"))


def read_room_file(path: Path, schema: dict[str, Any]) -> dict[str, Any]:
    """Return the content of a room file that matches `schema`."""
    content = read_yaml(path)
    check(content, schema, str(path))
    return content


def read_yaml(path: Path) -> Any:  # noqa: ANN401
    """Return the content of a YAML file."""
    try:
        with path.open("rb") as file:
            text = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    if len(text) > MAX_BYTES:
        raise BadInput(f"{path}: is too large, expected at most {MAX_BYTES} bytes")
    try:
        return yaml.load(text, Loader=StrictLoader)
    except yaml.MarkedYAMLError as error:
        line = f"line {error.problem_mark.line + 1}: " if error.problem_mark else ""
        raise BadInput(f"{path}: {line}{error.problem}, expected YAML") from error
    except (yaml.YAMLError, ValueError) as error:
        reason = " ".join(str(error).split())[:200]
        raise BadInput(f"{path}: {reason}, expected YAML") from error
