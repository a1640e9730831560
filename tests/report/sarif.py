"""What SARIF 2.1.0 asks of the parts that a report has; objects have no other properties."""


def _object(required="", optional="", **given):
    names = {name: given.get(name, {}) for name in (*required.split(), *optional.split())}
    return {
        "type": "object",
        "required": required.split(),
        "additionalProperties": False,
        "properties": names,
    }


TEXT = {"type": "string", "minLength": 1}
COUNT = {"type": "integer", "minimum": 1}
LEVEL = {"enum": ["none", "note", "warning", "error"]}
MESSAGE = _object("text", text=TEXT)
PLACE = _object(
    "artifactLocation",
    "region",
    artifactLocation=_object("uri", uri={"type": "string", "pattern": r"^[!-~]+$"}),
    region=_object(
        "startLine startColumn endLine endColumn",
        startLine=COUNT,
        startColumn=COUNT,
        endLine=COUNT,
        endColumn=COUNT,
    ),
)
LOCATION = _object(
    "physicalLocation",
    "id message logicalLocations",
    id={"type": "integer", "minimum": 0},
    physicalLocation=PLACE,
    message=MESSAGE,
    logicalLocations={"type": "array", "items": _object("name kind", name=TEXT, kind=TEXT)},
)
RULE = _object(
    "id shortDescription help defaultConfiguration properties",
    id={"type": "string", "pattern": "^[a-z0-9-]+$"},
    shortDescription=MESSAGE,
    help=MESSAGE,
    defaultConfiguration=_object("level enabled", level=LEVEL, enabled={"type": "boolean"}),
    properties=_object("tags", tags={"type": "array", "items": TEXT, "uniqueItems": True}),
)
REGION = PLACE["properties"]["region"]
FIX = _object(
    "artifactChanges",
    "description properties",
    description=MESSAGE,
    artifactChanges={
        "type": "array",
        "minItems": 1,
        "items": _object(
            "artifactLocation replacements",
            artifactLocation=PLACE["properties"]["artifactLocation"],
            replacements={
                "type": "array",
                "minItems": 1,
                "items": _object(
                    "deletedRegion",
                    "insertedContent",
                    deletedRegion=REGION,
                    insertedContent=_object("text", text={"type": "string"}),
                ),
            },
        ),
    },
    properties=_object("applicability", applicability={"enum": ["safe", "unsafe"]}),
)
RESULT = _object(
    "ruleId ruleIndex level message locations partialFingerprints",
    "relatedLocations suppressions fixes",
    fixes={"type": "array", "uniqueItems": True, "items": FIX},
    ruleId=TEXT,
    ruleIndex={"type": "integer", "minimum": 0},
    level=LEVEL,
    message=MESSAGE,
    locations={"type": "array", "items": LOCATION, "minItems": 1},
    relatedLocations={"type": "array", "items": LOCATION, "uniqueItems": True},
    partialFingerprints={"type": "object", "additionalProperties": TEXT},
    suppressions={
        "type": "array",
        "uniqueItems": True,
        "items": _object(
            "kind", "justification", kind={"enum": ["inSource", "external"]}, justification=TEXT
        ),
    },
)
INVOCATION = _object(
    "executionSuccessful",
    "toolExecutionNotifications",
    executionSuccessful={"type": "boolean"},
    toolExecutionNotifications={
        "type": "array",
        "items": _object(
            "message level locations",
            message=MESSAGE,
            level=LEVEL,
            locations={"type": "array", "items": LOCATION},
        ),
    },
)
RUN = _object(
    "tool columnKind invocations results",
    tool=_object(
        "driver",
        driver=_object(
            "name semanticVersion rules",
            name={"const": "urdftool"},
            semanticVersion=TEXT,
            rules={"type": "array", "items": RULE, "uniqueItems": True},
        ),
    ),
    columnKind={"const": "unicodeCodePoints"},
    invocations={"type": "array", "items": INVOCATION},
    results={"type": "array", "items": RESULT},
)
SARIF = _object(
    "$schema version runs",
    version={"const": "2.1.0"},
    runs={"type": "array", "items": RUN, "minItems": 1, "maxItems": 1},
)
