"""Words that the project does not use, and the verbs with which names and docstrings begin."""

from __future__ import annotations

import re

REPLACED = {
    r"what (?:is|can be) seen(?: of)?|what one sees": "visual geometry",
    r"what (?:touches|collides|could touch)": "collision geometry, contact",
    r"\bnail(?:ed|s|ing)?\b": "fixed base, welded to the world",
    r"\b(?:is|are|was|were|be) said\b|\bsaid aloud\b|\bsays? (?:so|it|that|of)\b": (
        "is reported, is printed"
    ),
    r"\b(?:is|are|was|were|be) told\b|\btells?\b(?! whether)": "reports, notifies, distinguishes",
    r"\bmend(?:ed|s|ing)?\b|\bremade?\b": "fix, repair, rewrite",
    r"\bh[au]ngs? (?:on|from)\b|\bhang(?:s|ing)?\b": "is a child of; depends on",
    r"\bweigh(?:s|ed|ing)?\b": "has mass",
    r"\b(?:is|are|was|be) wanted\b|\bwants?\b|\bfor want of\b": "requires, must be, expected",
    r"\bbesides?\b": "next to, relative to, in addition to, offset from",
    r"\bin each other\b|\bthrough each other\b": "interpenetrate, overlap",
    r"\blet (?:be|pass|alone)\b|\bpass(?:es|ed)? over\b": "ignored, skipped, tolerated",
    r"(?<!there )\b(?:is|are|was|be) no (?:link|joint|number|file|mesh|robot|name|package|frame"
    r"|wheel|tree|shape|body|element|attribute|option|value|rule|plugin|sensor|root)s?\b": (
        "is not an X"
    ),
    r"\bno body has\b|\bno (?:rigid )?body (?:has|could|can|may)\b": "physically inconsistent",
    r"\b(?:is|are|reads?|be) otherwise\b|\botherwise than\b": "different",
    r"\b(?:whoever|wherever|whichever|whatever|whosoever)\b": "the caller, if",
    r"\banew\b|\bafresh\b|\bnothing kept\b": "recomputed, with an empty cache",
    r"\bmade[- ]up\b|\binvent(?:s|ed|ing)?\b": "a default that the engine uses; a placeholder",
    r"\bbl(?:ew|ows?) up\b": "diverged",
    r"\blimp\b": "unactuated",
    r"\bstrangers?\b": "untrusted input",
    r"\btrifles?\b|\bchok(?:e|ed|es)\b|\bghosts?\b|\bthe house\b|\baloud\b": "a term of the field",
    r"\bbears? (?:it|them|him|what|no|more|a|the)\b|\bbrakes?\b(?= what)": "supports",
    r"\bnobody\b|\bsomebody\b|\bone who\b": "the user, no reader",
    r"\bat (?:heart|hand|once)\b(?<!all at once)": "immediately",
    r"\bwelcome\b|\bworthy\b|\bneat(?:ly)?\b": "valid, canonical",
    r"\bits (?:like|own like)\b|\bthe likes? of\b": "similar",
    r"\bthe same as ever\b|\bas ever\b": "unchanged",
}
"""Patterns of the private language, each with what to write."""

BRITISH = {
    r"\bcolour": "color",
    r"\bcentre[sd]?\b|\bcentred\b": "center",
    r"\b(?:milli|centi|kilo|micro)?metres?\b": "meter",
    r"\bbehaviou?r(?<!behavior)": "behavior",
    r"\bneighbour": "neighbor",
    r"\bgrey\b": "gray",
    r"\b(?:normal|real|organ|optim|minim|maxim|initial|serial|recogn|summar|visual|general|final"
    r"|synchron|parametr|linear|discret|regular|special|author|custom|triangul|voxel)"
    r"is(?:e[sdr]?|ing|ation)\b": "-ize",
    r"\banalys(?:e[sd]?|ing)\b(?!is)": "analyze",
    r"\blabell(?:ed|ing)\b|\bmodell(?:ed|ing)\b|\bcancell(?:ed|ing)\b|\btravell": "one l",
    r"\blicence\b": "license",
    r"\bmisspelt\b|\blearnt\b|\bburnt\b": "misspelled",
    r"\bcatalogue\b|\bdialogue\b": "catalog",
    r"\bfavour|\bhonour|\bharbour|\brumour": "-or",
    r"\bcheque\b|\btyre\b|\baluminium\b|\bprogramme\b": "American spelling",
}
"""British spellings, each with the American one."""

VERBS = frozenset(
    re.findall(
        r"\w+",
        """
        abort accept accumulate add adjust advance align allow anchor announce append apply
        approximate ask assemble assert assign attach average begin bind blank blend block blur
        bound build cache call canonicalize cap cast change check choose clamp clear clip close
        cluster collect color combine compact compare compile complete compose compress compute
        concatenate configure connect consider construct convert copy correct count couple cover
        create cut decide decimate declare decode decompose decorate deduplicate delete describe
        deserialize detach detect determine diagnose diagonalize digest disable discard dissolve
        distribute divide download draw drive drop dump edit emit enable encode end enforce enlarge
        ensure enter enumerate escape estimate evaluate exchange exclude execute exit expand explain
        export expose express extend extract feed fetch fill filter find finish fit fix flatten flip
        flood fold follow forbid force forecast forget format freeze fuse gather generate get give
        group grow guard guess halve handle hash hide highlight hold identify ignore implement
        import include increment indent index infer inherit initialize insert inspect install
        integrate interpolate intersect invert invoke iterate join judge keep kill label launch lay
        leave let lift light limit link list load localize locate lock log look lower lump make map
        mark mask match materialize measure memoize merge mirror mix move multiply name narrow
        negate nest normalize notify number observe offer offset open order orient overlay override
        overwrite pack pad paint pair parse partition pass pause peek perform pick pickle place plan
        plot poll position precompute prefetch prefix prepare prepend preserve print probe process
        produce project propagate propose prove provide prune publish pull push put qualify quantize
        query quote raise rank read rebuild receive recenter recognize recompute record redirect
        reduce refer refine refit refresh refuse register reject relate release reload remove rename
        render repair repeat replace report represent request require reset resize resolve restore
        restrict resume retag retrieve return reuse reverse review revolve rewrite rotate round
        route run sample sanitize save scale scan schedule score search select send separate
        serialize serve set settle shade shift shorten show shrink simplify simulate skip slice
        smooth snap solve sort spawn splice split spread start state step stop store stream strip
        submit substitute subtract suggest sum summarize supply support suppress swap sweep sync
        take tell terminate tessellate test thicken time tint toggle trace track transform translate
        transpose traverse triangulate trim trust try turn unblock undo unescape unify unite unpack
        unwrap update use validate verify view visit voxelize wait walk warn watch weld widen wrap
        write yield zip
        """,
    )
)
"""Verbs with which the docstring and the name of a function may begin."""

PREDICATES = frozenset(
    (
        *("is", "has", "can", "are", "was", "may", "should"),
        *("allows", "applies", "begins", "contains", "covers", "defines", "depends", "explains"),
        *("keeps", "matches", "needs", "reads", "repeats"),
        *("collides", "deletes", "dominates", "exceeds", "exists", "follows", "holds", "looks"),
        *("measures", "meets", "moves", "overlaps", "refuses", "rolls", "senses", "sets"),
        *("slides", "slows", "stays", "turns", "yields"),
    )
)
"""Beginnings of names of functions that return a truth value."""


def compiled(table: dict[str, str]) -> list[tuple[re.Pattern[str], str]]:
    """Compile the patterns of a table."""
    return [(re.compile(pattern, re.IGNORECASE), write) for pattern, write in table.items()]
