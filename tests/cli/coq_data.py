# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the data of a file that taut formal has written: a reader of its own, for comparison with the certificate.

An applied constructor is a tuple that begins with its name, a record is a dict, numbers are fractions.
"""
import re
from fractions import Fraction

TOKEN = re.compile(r"\s*(\{\||\|\}|:=|%Z|[-+]?0x[0-9a-f.]+p[-+]?\d+|-?\d[\d.]*(?:e[-+]?\d+)?|\w+|[()\[\],;#])")


def tokens_of(text):
    text, position, tokens = text.strip(), 0, []
    while position < len(text):
        match = TOKEN.match(text, position)
        assert match, f"unexpected: {text[position:position + 40]!r}"
        tokens.append(match.group(1))
        position = match.end()
    return [token for token in tokens if token != "%Z"]


def number(token):
    if "0x" not in token:
        return Fraction(token)
    sign, whole, part, exponent = re.fullmatch(r"([-+]?)0x([0-9a-f]+)\.?([0-9a-f]*)p([-+]?\d+)", token).groups()
    value = Fraction(int(whole + part, 16)) / 16 ** len(part) * Fraction(2) ** int(exponent)
    return -value if sign == "-" else value


class Reader:
    def __init__(self, text):
        self.tokens = tokens_of(text)

    def take(self, *expected):
        token = self.tokens.pop(0)
        assert not expected or token in expected, (token, expected)
        return token

    def next_is(self, *tokens):
        return bool(self.tokens) and self.tokens[0] in tokens

    def atom(self):
        token = self.take()
        if token == "(":
            value = [self.term()]
            while self.next_is(","):
                self.take()
                value.append(self.term())
            self.take(")")
            return value[0] if len(value) == 1 else tuple(value)
        if token == "[":
            return self.listed("]", self.term)
        if token == "{|":
            return dict(self.listed("|}", self.field))
        return number(token) if re.match(r"[-+]?\d", token) else token

    def listed(self, end, part):
        values = []
        while not self.next_is(end):
            values.append(part())
            if not self.next_is(end):
                self.take(";")
        self.take(end)
        return values

    def field(self):
        name = self.take()
        self.take(":=")
        return name, self.term()

    def term(self):
        parts = [self.atom()]
        while self.tokens and not self.next_is(")", "]", ",", ";", "|}", "#"):
            parts.append(self.atom())
        if self.next_is("#"):
            self.take()
            return parts[0] / self.atom()
        return parts[0] if len(parts) == 1 else tuple(parts)


def read(text):
    """{name of the definition: its data}"""
    text = re.sub(r"\(\*.*?\*\)", "", text, flags=re.S)
    return {name: Reader(body).term()
            for name, body in re.findall(r"^Definition (\w+) : \w+ := (.*?)\.\n(?:\n|$)", text + "\n", re.S | re.M)}
