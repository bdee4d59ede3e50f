# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Seeded mutations of files: bytes of any, the structure of JSON, YAML, XML, meshes, tar, PNG, zip and tensors.

A mutation takes (bytes, random.Random) and returns other bytes, the same for the same state of the generator. One that
finds nothing of its kind in the file flips a bit. Where a format carries a checksum or a length of its own, the
mutation mends it, so that readers go on behind it.
"""
import collections
import io
import json
import random
import re
import struct
import zipfile
import zlib
from collections.abc import Callable

Mutation = Callable[[bytes, random.Random], bytes]

# A path that a name in a file must not lead to: beside the input and the output of a run, at several depths, and
# absolute. ESCAPE stands for the folder of the run, which differs between machines.
ESCAPE = "@ESCAPE@"
HOSTILE_NAMES = [
    "", ".", "..", "/", "../../around/victim", "../around/victim", "../../../around/victim", "../escaped",
    f"{ESCAPE}/around/victim", f"{ESCAPE}/escaped", "a/b", "a\\b", "-rf", "<script>alert(1)</script>", "line\nbreak",
    "\u0000", "\x1b[31mred", "x" * 121, "x" * 300, "x" * 70000, "\u202e", "é", "NaN", "name with spaces", "%s%n", "~"
]
EXTREME_NUMBERS = [
    b"0", b"-0.0", b"-1", b"1e300", b"-1e300", b"1e-300", b"1e39", b"nan", b"-inf", b"343600", b"343598.5", b"99.9",
    b"-99.9", b"101", b"1000", b"20000", b"2147483647", b"2147483648", b"-2147483649", b"4294967297",
    b"9223372036854775808", b"18446744073709551616", b"-9223372036854775809", b"0x10", b"1e", b"1e400", b"00012",
    b"9" * 400, b"3.0000000000000000000000000001", b"0.5"
]
NOT_UTF8 = [b"\xff", b"\xc0\x80", b"\xed\xa0\x80", b"\xf8\x88\x80\x80\x80", b"\xe9"]

# ---- bytes of any file ----------------------------------------------------------------------------------------------


def flip_bit(content: bytes, random: random.Random) -> bytes:
    if not content:
        return b"\x00"
    at = random.randrange(len(content))
    return content[:at] + bytes([content[at] ^ (1 << random.randrange(8))]) + content[at + 1:]


def set_byte(content: bytes, random: random.Random) -> bytes:
    at = random.randrange(len(content) + 1)
    return content[:at] + bytes([random.choice([0, 10, 32, 34, 47, 127, 128, 255])]) + content[at + 1:]


def cut(content: bytes, random: random.Random) -> bytes:
    return content[:random.randrange(len(content) + 1)]


def drop_piece(content: bytes, random: random.Random) -> bytes:
    begin = random.randrange(len(content) + 1)
    return content[:begin] + content[begin + random.randint(1, 64):]


def repeat_piece(content: bytes, random: random.Random) -> bytes:
    begin = random.randrange(len(content) + 1)
    piece = content[begin:begin + random.randint(1, 256)]
    return content[:begin] + piece * random.choice([2, 3, 200]) + content[begin + len(piece):]


def swap_pieces(content: bytes, random: random.Random) -> bytes:
    if len(content) < 2:
        return flip_bit(content, random)
    first, second = sorted(random.sample(range(len(content)), 2))
    length = min(random.randint(1, 64), second - first, len(content) - second)
    return (content[:first] + content[second:second + length] + content[first + length:second] +
            content[first:first + length] + content[second + length:])


def append_bytes(content: bytes, random: random.Random) -> bytes:
    return content + random.choice([b"\n", b"\x00", b"garbage", bytes(4096), content[:100]])


def replace_all(content: bytes, random: random.Random) -> bytes:
    return random.choice([
        b"", b"\x00", b"garbage", b"{}", b"[]", b"null", b"\xff\xfe", b"[" * 200000, b'{"a":' * 200000, b"a: &a [*a]\n",
        b"<a>" * 5000, content[:len(content) // 2] * 2,
        random.randbytes(500)
    ])


def insert_not_utf8(content: bytes, random: random.Random) -> bytes:
    at = random.randrange(len(content) + 1)
    return content[:at] + random.choice(NOT_UTF8) + content[at:]


# ---- numbers and lines of any text ----------------------------------------------------------------------------------


def change_number(content: bytes, random: random.Random) -> bytes:
    numbers = list(re.finditer(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?", content))
    if not numbers:
        return flip_bit(content, random)
    number = random.choice(numbers)
    return content[:number.start()] + random.choice(EXTREME_NUMBERS) + content[number.end():]


def change_digit(content: bytes, random: random.Random) -> bytes:
    """A small lie: one digit becomes another."""
    digits = [at for at, byte in enumerate(content) if 48 <= byte <= 57]
    if not digits:
        return flip_bit(content, random)
    at = random.choice(digits)
    other = random.choice([digit for digit in range(48, 58) if digit != content[at]])
    return content[:at] + bytes([other]) + content[at + 1:]


def change_line(content: bytes, random: random.Random) -> bytes:
    lines = content.split(b"\n")
    at = random.randrange(len(lines))
    change = random.randrange(4)
    if change == 0:
        del lines[at]
    elif change == 1:
        lines.insert(at, lines[at])
    elif change == 2:
        other = random.randrange(len(lines))
        lines[at], lines[other] = lines[other], lines[at]
    else:
        lines[at] = lines[at] * random.choice([2, 1000])
    return b"\n".join(lines)


def as_text(name: str) -> bytes:
    return name.encode("utf-8", "surrogatepass")


# ---- JSON -----------------------------------------------------------------------------------------------------------


def json_places(value: object, place: tuple = ()) -> list[tuple]:
    """Paths of all values below the root."""
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    places = [place] if place else []
    for key, child in children:
        places += json_places(child, place + (key,))
    return places


def value_at(document: object, place: tuple) -> object:
    for key in place:
        document = document[key]
    return document


def nested(depth: int) -> object:
    value: object = 1
    for _ in range(depth):
        value = [value]
    return value


def kind_of(place: tuple) -> tuple:
    """Places of one kind differ in list positions alone; a document has few kinds and maybe very many numbers."""
    return tuple("" if isinstance(key, int) else key for key in place)


def choose_place(places: list[tuple], random: random.Random) -> tuple:
    kinds = collections.defaultdict(list)
    for place in places:
        kinds[kind_of(place)].append(place)
    return random.choice(kinds[random.choice(sorted(kinds))])


def json_value(value: object, random: random.Random) -> object:
    return random.choice([
        None, True, "text", [], {}, [value], {"a": value}, -1, 0, 0.5, 1e300,
        float("nan"), 2**31, 2**32 + 1, 2**63, 2**64, -2**63, -2**63 - 1,
        nested(60),
        nested(70),
        nested(900),
        list(range(3000))
    ])


def json_change(document: object, random: random.Random) -> None:
    """One value of the document becomes another, is removed, doubled, or trades places."""
    places = json_places(document)
    place = choose_place(places, random)
    parent, last = value_at(document, place[:-1]), place[-1]
    value = parent[last]
    change = random.randrange(9)
    if change == 0:
        del parent[last]
    elif change == 1 or (change == 2 and isinstance(value, str)):
        parent[last] = random.choice(HOSTILE_NAMES)
    elif change <= 3:
        parent[last] = json_value(value, random)
    elif change == 4:
        if isinstance(parent, dict):
            parent["unknown_" + random.choice(HOSTILE_NAMES)] = value
        else:
            parent.insert(random.choice([0, last, len(parent)]), value)
    elif change == 5 and isinstance(parent, dict):
        del parent[last]
        parent[last.upper() if random.random() < 0.5 else last[:-1]] = value
    elif change == 6 and isinstance(value, list):
        value.reverse() if random.random() < 0.5 else value.extend(value * random.choice([1, 400]))
    else:  # swapped records: what stands elsewhere under the same name, or anywhere
        alike = [other for other in places if other[-1] == last and other != place]
        other = random.choice(alike or places)
        parent[last] = value_at(document, other)


def change_json(content: bytes, random: random.Random) -> bytes:
    try:
        document = json.loads(content)
    except (ValueError, RecursionError):
        return flip_bit(content, random)
    if not json_places(document):
        return replace_all(content, random)
    json_change(document, random)
    try:
        text = json.dumps(document, indent=random.choice([None, 2]), ensure_ascii=random.random() < 0.5)
    except ValueError:  # a value that now holds itself
        return flip_bit(content, random)
    return as_text(text) + b"\n"


def change_json_text(content: bytes, random: random.Random) -> bytes:
    """What no JSON library writes: keys that occur twice, comments, lone surrogates, depth, huge text."""
    members = list(re.finditer(rb'"([^"\\\n]*)"\s*:\s*("[^"\\\n]*"|-?[0-9.eE+-]+|true|false|null)', content))
    if not members:
        return flip_bit(content, random)
    member = random.choice(members)
    key = b'"' + member.group(1) + b'": '
    new = random.choice([
        key + random.choice([b"1", b'"../../around/victim"', b"null"]) + b", " + member.group(),
        member.group() + b", " + key + random.choice([b"1", b'"twice"', b"{}"]), key + b'"\\ud800"', key + b'"\\u0000"',
        key + b'"' + random.choice(NOT_UTF8) + b'"', key + b"[" * 200000 + b"]" * 200000,
        key + b'{"a":' * 66 + b"1" + b"}" * 66, key + b'"' + b"x" * 1000000 + b'"', key + b"1" + b"0" * 5000,
        b"/* comment */ " + member.group(),
        member.group() + b",", key + b"NaN", key + b"-Infinity", key + b"+1", key + b".5"
    ])
    return content[:member.start()] + new + content[member.end():]


def change_json_line(content: bytes, random: random.Random) -> bytes:
    """One line of a file of JSON lines."""
    lines = content.split(b"\n")
    filled = [number for number, line in enumerate(lines) if line.strip()]
    if not filled:
        return append_bytes(content, random)
    at = random.choice(filled)
    lines[at] = random.choice([change_json, change_json_text])(lines[at], random).replace(b"\n", b"")
    return b"\n".join(lines)


# ---- YAML -----------------------------------------------------------------------------------------------------------

YAML_BOMBS = [
    b"a: &a [*a]\n", b"&a {b: *a}\n", b"? [a, b]\n: 1\n", b"a: !!binary x\n", b"a: !<tag:example.org,2026:x> {}\n",
    b"<<: *missing\n", b"a: &b 1\n<<: {a: 2}\n", b"- " * 300, b"{" * 300, b"[" * 20000,
    b"a:\n" + b"".join(b" " * i + b"a:\n" for i in range(1, 90)), b"--- 1\n--- 2\n", b"%YAML 9.9\n---\na: 1\n",
    b"a: 1\na: 2\n", b"a: '" + b"x" * 2000000 + b"'\n", b"\xef\xbb\xbfa: 1\n", b"a: |\n" + b"  line\n" * 20000,
    b"a: 1\n\ta: 2\n", b"a: [" + b"1, " * 200000 + b"1]\n",
    b"".join(b"%c: &%c [%s]\n" % (97 + i, 97 + i, b",".join([b"*%c" % (96 + i)] * 9) if i else b"1,1")
             for i in range(10))
]
YAML_VALUES = [
    b"[]", b"{}", b"~", b"[1, 2, 3, 4, 5]", b"{a: {b: {c: 1}}}", b"!!str 1", b"&x 1", b"*x", b".nan", b"-.inf", b"yes",
    b"1_000", b"'", b"["
]


def change_yaml(content: bytes, random: random.Random) -> bytes:
    if random.random() < 0.3:
        bomb = random.choice(YAML_BOMBS)
        return random.choice([bomb, content + bomb, bomb + content])
    lines = content.split(b"\n")
    filled = [number for number, line in enumerate(lines) if line.strip()] or [0]
    at = random.choice(filled)
    if random.random() < 0.15:
        lines[at] = b" " * random.choice([1, 2, 7]) + lines[at]
        return b"\n".join(lines)
    key, colon, _ = lines[at].partition(b":")
    value = random.choice(EXTREME_NUMBERS + [as_text(name) for name in HOSTILE_NAMES] + YAML_VALUES * 2)
    lines[at] = key + colon + b" " + value
    return b"\n".join(lines)


# ---- XML ------------------------------------------------------------------------------------------------------------


def change_xml(content: bytes, random: random.Random) -> bytes:
    tags = list(re.finditer(rb"<[^>]*>", content))
    values = list(re.finditer(rb'"[^"]*"', content))
    change = random.randrange(6)
    if change == 0 and tags:
        tag = random.choice(tags)
        return content[:tag.start()] + content[tag.end():]
    if change == 1 and tags:
        tag = random.choice(tags)
        return content[:tag.end()] + tag.group() * random.choice([1, 300]) + content[tag.end():]
    if change == 2 and len(values) > 1:
        value, other = random.sample(values, 2)
        return content[:value.start()] + other.group() + content[value.end():]
    if change == 3 and tags:
        at = random.choice(tags).start()
        text = random.choice([
            b"<!DOCTYPE r [<!ENTITY a \"aaaa\">]>", b"<!-- -- -->", b"<![CDATA[", b"<?x?>", b"&a;", b"&#0;",
            b"&#xd800;", b"<a>" * 70, b"<a " + b" ".join(b'b%d=""' % i for i in range(5000)) + b"/>", b"\x00",
            b"<a" * 3000
        ])
        return content[:at] + text + content[at:]
    if values:
        value = random.choice(values)
        new = random.choice(EXTREME_NUMBERS + [as_text(name) for name in HOSTILE_NAMES] +
                            [b"0 0 343600", b"0 0", b"1 2 3 4", b"0 0 0", b"0 0 99", b"1e-9 1e-9 1e-9"])
        return content[:value.start()] + b'"' + new.replace(b'"', b"").replace(b"<",
                                                                               b"&lt;") + b'"' + content[value.end():]
    return flip_bit(content, random)


def change_robot(content: bytes, random: random.Random) -> bytes:
    """Links and joints of a URDF: chains, cycles, two parents, none."""
    links = re.findall(rb'<link name="([^"]*)"', content)
    end = content.rfind(b"</robot>")
    if not links or end < 0:
        return flip_bit(content, random)
    first, last = random.choice(links), random.choice(links)

    def joint(number: int, parent: bytes, child: bytes) -> bytes:
        return b'<joint name="added%d" type="fixed"><parent link="%s"/><child link="%s"/></joint>' % (number, parent,
                                                                                                      child)

    change = random.randrange(3)
    if change == 0:
        added = joint(0, first, last)
    elif change == 1:
        count = random.choice([3, 200, 20000])
        names = [last] + [b"added%d" % number for number in range(count)]
        added = b"".join(b'<link name="%s"/>' % name
                         for name in names[1:]) + b"".join(joint(i, names[i], names[i + 1]) for i in range(count))
    else:
        added = b'<link name="%s"/>' % first + joint(0, first, b"missing")
    return content[:end] + added + content[end:]


# ---- meshes ---------------------------------------------------------------------------------------------------------


def change_mesh_text(content: bytes, random: random.Random) -> bytes:
    """A word of a line: a coordinate, an index or a count that no sound file has."""
    lines = content.split(b"\n")
    at = random.randrange(len(lines))
    words = lines[at].split(b" ")
    words[random.randrange(len(words))] = random.choice(EXTREME_NUMBERS + [b"-1", b"1/2/3", b"//", b"f", b"v", b""])
    lines[at] = b" ".join(words)
    return b"\n".join(lines)


def move_vertex(content: bytes, random: random.Random) -> bytes:
    """One vertex goes far away, or all do: distances below and above the allowed ones."""
    lines = content.split(b"\n")
    vertices = [
        number for number, line in enumerate(lines)
        if re.fullmatch(rb"(v )?\s*-?[\d.]+\S* -?[\d.]+\S* -?[\d.]+\S*\s*", line)
    ]
    if not vertices:
        return flip_bit(content, random)
    axis = -1 - random.randrange(3)
    new = random.choice([
        b"2.5", b"20", b"99.5", b"-99.5", b"150", b"1000", b"20000", b"343598.7", b"-343999", b"1e6", b"1e15", b"3e38",
        b"1e39", b"1e-40", b"nan"
    ])
    for number in vertices if random.random() < 0.1 else [random.choice(vertices)]:
        words = lines[number].split()
        words[axis] = new
        lines[number] = b" ".join(words)
    return b"\n".join(lines)


def change_faces(content: bytes, random: random.Random) -> bytes:
    """Faces of an OBJ with many corners, corners that are not there, and faces that lie on each other."""
    lines = content.split(b"\n")
    faces = [number for number, line in enumerate(lines) if line.startswith(b"f ")]
    if not faces:
        return flip_bit(content, random)
    at = random.choice(faces)
    change = random.randrange(4)
    if change == 0:
        count = random.choice([4, 50, 3000, 60000])
        lines.insert(at, b"f " + b" ".join(b"%d" % (1 + i % 8) for i in range(count)))
    elif change == 1:
        words = lines[at].split()
        words[-1] = random.choice(
            [b"0", b"-1", b"-9", b"9999999", b"2147483648", b"4294967297", b"18446744073709551617", b"1/0/0"])
        lines[at] = b" ".join(words)
    elif change == 2:
        lines[at:at + 1] = [lines[at]] * random.choice([2, 500])
    else:
        words = lines[at].split()
        lines[at] = b" ".join(words[:1] + words[:0:-1])
    return b"\n".join(lines)


def change_word(content: bytes, random: random.Random) -> bytes:
    """A 32 bit word of a binary file becomes a count or a number that no sound file has."""
    if len(content) < 8:
        return flip_bit(content, random)
    begin = 80 if len(content) > 200 else 0
    at = random.choice([80, 84]) if begin and random.random() < 0.2 else random.randrange(begin, len(content) - 4)
    word = random.choice([
        struct.pack("<f", random.choice([343600.0, 1e30,
                                         float("nan"), float("inf"), 1000.0, 99.0, 1e-42])),
        struct.pack("<I", random.choice([0xFFFFFFFF, 0x80000000, 0x7FFFFFFF, 0, 1 << 20]))
    ])
    return content[:at] + word + content[at + 4:]


def change_glb(content: bytes, random: random.Random) -> bytes:
    """The JSON chunk of a GLB, lengths mended."""
    if len(content) < 20 or content[:4] != b"glTF":
        return flip_bit(content, random)
    (length,) = struct.unpack("<I", content[12:16])
    text = random.choice([change_json, change_json, change_json_text, change_number])(content[20:20 + length].rstrip(),
                                                                                      random)
    text += b" " * (-len(text) % 4)
    rest = content[20 + length:]
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


# ---- containers: tar, PNG, zip, npy, safetensors --------------------------------------------------------------------


def tar_header(header: bytes, name: bytes | None = None, size: bytes | None = None) -> bytes:
    """With another name or size, its checksum mended."""
    new = bytearray(header)
    if name is not None:
        new[0:100] = name[:100].ljust(100, b"\0")
    if size is not None:
        new[124:136] = size[:12].ljust(12, b"\0")
    new[148:156] = b" " * 8
    new[148:156] = b"%06o\0 " % sum(new)
    return bytes(new)


def tar_members(content: bytes) -> list[tuple[int, str, int]]:
    """(where its header begins, name, size) of each member."""
    members, at = [], 0
    while at + 512 <= len(content) and content[at + 257:at + 262] == b"ustar":
        try:
            size = int(content[at + 124:at + 136].strip(b"\0 ") or b"0", 8)
        except ValueError:
            break
        members.append((at, content[at:at + 100].rstrip(b"\0").decode("utf-8", "replace"), size))
        at += 512 + -(-size // 512) * 512
    return members


def change_tar(content: bytes, random: random.Random) -> bytes:
    """A field of a header, the header's checksum mended; or a member is removed, doubled or trades places."""
    members = tar_members(content)
    if not members:
        return flip_bit(content, random)
    at, _, size = random.choice(members)
    end = at + 512 + -(-size // 512) * 512
    change = random.randrange(5)
    if change == 0:
        return content[:at] + content[end:]
    if change == 1:
        return content[:at] + content[at:end] * 2 + content[end:]
    header = bytearray(content[at:at + 512])
    begin, length = random.choice([(0, 100), (124, 12), (156, 1), (157, 100), (345, 155)])
    new = random.choice([b"../escaped", b"/tmp/escaped", b"77777777777", b"\x80" + b"\xff" * 11, b"5", b"2", b"\x00"])
    header[begin:begin + length] = new[:length].ljust(length, b"\0")
    return content[:at] + tar_header(bytes(header)) + content[at + 512:]


def change_tar_member(content: bytes, random: random.Random) -> bytes:
    """A member by the mutations of its own kind; size and header's checksum are mended."""
    members = tar_members(content)
    if not members:
        return flip_bit(content, random)
    suffix = random.choice(sorted({name[name.find("."):] for _, name, _ in members}))
    at, name, size = random.choice([member for member in members if member[1].endswith(suffix)])
    body, _ = mutated(content[at + 512:at + 512 + size], name[name.rfind("."):], random)
    end = at + 512 + -(-size // 512) * 512
    header = tar_header(content[at:at + 512], size=b"%011o" % len(body))
    return content[:at] + header + body + bytes(-len(body) % 512) + content[end:]


def change_png(content: bytes, random: random.Random) -> bytes:
    """A chunk, its checksum mended."""
    chunks, at = [], 8
    while at + 12 <= len(content):
        (length,) = struct.unpack(">I", content[at:at + 4])
        chunks.append((content[at + 4:at + 8], content[at + 8:at + 8 + length]))
        at += 12 + length
    if not chunks:
        return flip_bit(content, random)
    number = random.randrange(len(chunks))
    kind, body = chunks[number]
    change = random.randrange(5)
    if change == 0:
        del chunks[number]
    elif change == 1:
        chunks.insert(number, chunks[number])
    elif change == 2:
        width, height = random.choice([0, 1, 64, 65535, 2**31 - 1, 2**32 - 1]), random.choice([0, 1, 64, 50000, 2**31])
        header = struct.pack(">IIBB", width, height, random.choice([1, 8, 16, 32]), random.choice([0, 2, 3, 6, 9]))
        chunks[0] = (chunks[0][0], header + chunks[0][1][10:])
    elif change == 3:
        try:  # other pixels; level 0, whose bytes do not depend on the library
            chunks[number] = (kind, zlib.compress(repeat_piece(zlib.decompress(body), random), 0))
        except zlib.error:
            chunks[number] = (kind, flip_bit(body, random))
    else:
        chunks[number] = (kind, flip_bit(body, random))
    return content[:8] + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        for kind, body in chunks)


def change_zip(content: bytes, random: random.Random) -> bytes:
    """A member of a zip, its checksums mended: bytes, name, method, or a copy of it."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as source:
            members = [(item.filename, source.read(item)) for item in source.infolist()]
    except (zipfile.BadZipFile, NotImplementedError, ValueError, zlib.error, OSError, EOFError, RuntimeError):
        return flip_bit(content, random)
    if not members:
        return flip_bit(content, random)
    number = random.randrange(len(members))
    name, body = members[number]
    change = random.randrange(8)
    if change == 0:
        del members[number]
    elif change == 1:
        members[number] = (random.choice(["../../around/victim", "x" * 300, "archive/data.pkl", "é"]), body)
    elif change == 2:
        members[number] = (name, body * random.choice([2, 100]))
    else:
        members[number] = (name, random.choice([flip_bit, set_byte, drop_piece, repeat_piece, change_pickle])(body,
                                                                                                              random))
    method = zipfile.ZIP_DEFLATED if random.random() < 0.1 else zipfile.ZIP_STORED
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as target:
        for name, body in members:
            target.writestr(zipfile.ZipInfo(name), body, method)
    return out.getvalue()


def change_pickle(content: bytes, random: random.Random) -> bytes:
    """Operations that a reader of tensors must not carry out, or numbers that it must not believe."""
    at = random.randrange(len(content) + 1)
    new = random.choice([
        b"cos\nsystem\n", b"(S'touch escaped'\ntR.", b"\x8a\xff" + b"\x7f" * 255, b"J\xff\xff\xff\x7f", b"h\xff",
        b"j\xff\xff\xff\xff", b"B\xff\xff\xff\x7f", b"(" * 5000, b"]" * 5000, b"2" * 5000, b"Q", b"R", b"M\xff\xff",
        b"."
    ])
    return content[:at] + new + content[at:]


def change_npy(content: bytes, random: random.Random) -> bytes:
    """The header's words; its length is mended half of the time."""
    if content[:6] != b"\x93NUMPY" or len(content) < 12:
        return flip_bit(content, random)
    (length,) = struct.unpack("<H", content[8:10])
    header = content[10:10 + length]
    word = random.choice(list(re.finditer(rb"'[^']*'|\d+|True|False|\(|\)|,|\{|\}", header)) or [None])
    if word is None:
        return flip_bit(content, random)
    new = random.choice([
        b"'<f8'", b"'|O'", b"'>f4'", b"'<f4'", b"True", b"0", b"-1", b"4294967296", b"18446744073709551616", b"1" * 60,
        b"(", b"((((", b"", b"(1,)*9", b"'x'", b"\xff"
    ])
    header = header[:word.start()] + new + header[word.end():]
    if random.random() < 0.5:
        header = header.rstrip(b" \n") + b" " * max(0, length - len(header.rstrip(b" \n")) - 1) + b"\n"
    return content[:8] + struct.pack("<H", min(65535, len(header))) + header + content[10 + length:]


def change_tensors(content: bytes, random: random.Random) -> bytes:
    """The JSON header of safetensors; its length is mended."""
    if len(content) < 8:
        return flip_bit(content, random)
    (length,) = struct.unpack("<Q", content[:8])
    header, rest = content[8:8 + length], content[8 + length:]
    if random.random() < 0.1:
        return struct.pack("<Q", random.choice([0, 1, length - 1, length + 8, 2**32, 2**63, 2**64 - 1])) + header + rest
    header = random.choice([change_json, change_json, change_json_text, change_number])(header, random)
    return struct.pack("<Q", len(header)) + header + rest


# ---- which mutations a file gets ------------------------------------------------------------------------------------

ANY: list[Mutation] = [flip_bit, set_byte, cut, drop_piece, repeat_piece, swap_pieces, append_bytes, replace_all]
TEXT = ANY + [insert_not_utf8, change_number, change_number, change_digit, change_line]
XML = TEXT + [change_xml] * 10
BY_SUFFIX: dict[str, list[Mutation]] = {
    ".json": TEXT + [change_json] * 14 + [change_json_text] * 4,
    ".jsonl": TEXT + [change_json_line] * 6,
    ".journal": TEXT + [change_json_line] * 3,
    ".txt": TEXT,
    ".md": TEXT,
    ".yaml": TEXT + [change_yaml] * 10,
    ".urdf": XML + [change_robot] * 3,
    ".dae": XML,
    ".obj": TEXT + [change_mesh_text] * 4 + [move_vertex] * 5 + [change_faces] * 4,
    ".mtl": TEXT,
    ".off": TEXT + [change_mesh_text] * 5 + [move_vertex] * 5,
    ".ply": TEXT + [change_mesh_text] * 5 + [move_vertex] * 3,
    ".stl": ANY + [change_word] * 8,
    ".glb": ANY + [change_word] * 4 + [change_glb] * 8,
    ".tar": ANY + [change_tar] * 5 + [change_tar_member] * 8,
    ".partial": ANY + [change_tar] * 5 + [change_tar_member] * 3,
    ".png": ANY + [change_png] * 8,
    ".npy": ANY + [change_npy] * 8,
    ".torch": ANY + [change_zip] * 10,
    ".safetensors": ANY + [change_tensors] * 8 + [change_word] * 4,
}


def mutated(content: bytes, suffix: str, random: random.Random) -> tuple[bytes, list[str]]:
    """Other bytes than `content`, and the names of the mutations that made them."""
    kind = ".torch" if suffix == ".npy" and content[:2] == b"PK" else suffix
    names: list[str] = []
    result = content
    while result == content:
        for _ in range(2 if random.random() < 0.15 else 1):
            mutation = random.choice(BY_SUFFIX.get(kind, ANY))
            names.append(mutation.__name__)
            result = mutation(result, random)
    return result, names
