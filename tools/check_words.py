#!/usr/bin/env python3
"""Fails where an identifier in C++ sources has a word that is none of the field's (position, not place; fraction or
weight, not share; displacement or direction, not way; pinned, not held; kMax, not kMost). Strings and comments may say
what they like, and so may the sentences that tests are named by.

check_words.py FILE..."""
import re
import sys

# A word of an identifier (camelCase, snake_case) -> what to write.
WORDS = {
    "place": "position, index or location", "places": "positions, indices or locations", "placer": "what it does",
    "way": "displacement, direction, path or distance", "ways": "displacements, directions or distances",
    "share": "fraction or weight", "shares": "fractions, weights or influences",
    "stands": "is upright, rests or stance", "held": "pinned or constrained", "told": "reported",
    "guess": "hypothesis or estimate", "guesses": "hypotheses",
}
STARTS = {  # of an identifier
    r"kMost(?=[A-Z_]|$)": "kMax", r"kLeast(?=[A-Z_]|$)": "kMin", r"most(?=[A-Z])": "max", r"least(?=[A-Z])": "min",
}
ALLOWED = {  # whole identifiers -> why
    r"\w*[iI]nPlace": "'in place' is an idiom",
    r"(is)?[hH]eldOut\w*": "held-out data",
    r"limber_session_places": "exported to JavaScript under this name",
    # The verb, 'to put there', with what is put.
    r"place(Between|Children|Each|Hands|Hindquarters|Joint|KeptNodes|Leg|Loose|Member|Nodes|PairsChildren|Paws|Person"
    r"|QuadrupedLeg|Root|Skin)": "the verb",
    r"Place(Joint|Member)(Test)?": "the commands place_joint and place_member",
}

TOKEN = re.compile(r"""
    (?:u8|u|U|L)?R"(?P<d>[^()\\\s]{0,16})\(.*?\)(?P=d)"
  | //(?:\\\n|[^\n])* | /\*.*?\*/ | ^[ \t]*\#[ \t]*include[^\n]*
  | (?:u8|u|U|L)?"(?:\\.|[^"\\\n])*" | \.?\d(?:'?[\w.]|[eEpP][+-])* | (?:u8|u|U|L)?'(?:\\.|[^'\\\n])*'
  | \bTEST(?:_F|_P)?\((?P<suite>\w+),\s*\w+
  | (?P<id>[A-Za-z_]\w*)""", re.X | re.S | re.M)


def advice(name):
    """What to write instead of a word of `name`, or None."""
    if any(re.fullmatch(pattern, name) for pattern in ALLOWED):
        return None
    for start, instead in STARTS.items():
        if re.match(start, name):
            return instead
    for part in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name):
        if part.lower() in WORDS:
            return WORDS[part.lower()]
    return None


def main():
    faults = 0
    for file in sys.argv[1:]:
        with open(file, encoding="utf-8") as opened:
            text = opened.read()
        seen = set()
        for match in TOKEN.finditer(text):
            name = match.group("id") or match.group("suite")
            if not name or name in seen:
                continue
            seen.add(name)
            instead = advice(name)
            if instead:
                faults += 1
                print(f"{file}:{text.count(chr(10), 0, match.start()) + 1}: '{name}': write {instead}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
