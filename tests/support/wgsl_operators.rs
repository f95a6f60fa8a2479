//! Checks WGSL's grammar of binary operators, where naga is more lenient than browsers are.
//!
//! The operands of `&`, `|` and `^` are unary expressions or the same operator's; those of `<<` and `>>` are unary
//! expressions; `&&` and `||` take relations and do not mix; relations do not chain. Anything else needs parentheses
//! (<https://www.w3.org/TR/WGSL/#expression-grammar>).

/// Holds the state of a bracket. The operators of each bracket, of each argument between commas, and of each statement
/// are checked by themselves.
#[derive(Default)]
struct Level {
    /// Lists the binary operators since the last comma, semicolon, brace or assignment.
    operators: Vec<String>,
    /// States that the last token was the end of an operand, so that an operator after it is binary.
    after_operand: bool,
}

/// Returns the positions where the text violates the grammar, each with its line.
pub fn mixed_operators(source: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let mut levels = vec![Level::default()];
    for (line, tokens) in (1..).zip(tokens_of_lines(source)) {
        for token in tokens {
            let level = levels.last_mut().expect("a level");
            let mut end = |level: &mut Level| {
                if let Some(fault) = fault(&level.operators) {
                    faults.push(format!("line {line}: {fault} want parentheses"));
                }
                level.operators.clear();
                level.after_operand = false;
            };
            match token.as_str() {
                "(" | "[" | "template<" => levels.push(Level::default()),
                ")" | "]" | ">template" => {
                    end(level);
                    levels.pop();
                    if levels.is_empty() {
                        faults.push(format!("line {line}: a bracket too many"));
                        return faults;
                    }
                    levels.last_mut().expect("a level").after_operand = true;
                }
                "{" | "}" | ";" | "," | ":" | "=" | "->" | "@" => end(level),
                word if word.len() > 1 && word.ends_with('=') && !is_relation(word) => end(level),
                // These begin an expression; what follows them is not a binary operator.
                "return" | "if" | "while" | "switch" | "case" | "else" => end(level),
                "++" | "--" => {}
                operator if is_operator(operator) => {
                    if level.after_operand {
                        level.operators.push(operator.to_owned());
                    }
                    level.after_operand = false;
                }
                _ => level.after_operand = true,
            }
        }
    }
    if levels.len() != 1 {
        faults.push("a bracket is not closed".to_owned());
    }
    faults
}

/// Returns two operators that may not be combined without parentheses.
fn fault(operators: &[String]) -> Option<String> {
    let first = |found: fn(&str) -> bool| operators.iter().find(|operator| found(operator));
    let bitwise = first(|operator| ["&", "|", "^"].contains(&operator));
    let shift = first(|operator| ["<<", ">>"].contains(&operator));
    let logic = first(|operator| ["&&", "||"].contains(&operator));
    let pair = |one: &String, other: &String| Some(format!("`{one}` and `{other}`"));
    if let Some(bitwise) = bitwise {
        // A binary `&` is an operand of nothing else either: relations and logic consist of shifts and sums.
        return operators
            .iter()
            .find(|operator| *operator != bitwise)
            .and_then(|other| pair(bitwise, other));
    }
    // Relations and logic take shifts as operands; between two of those each run is checked by itself.
    let mut runs = operators.split(|operator| is_relation(operator) || is_logic(operator));
    if let Some(shift) = shift {
        let crowded = runs.find(|run| run.len() > 1 && run.contains(shift));
        if let Some(run) = crowded {
            let other = run.iter().find(|operator| *operator != shift);
            return pair(shift, other.unwrap_or(shift));
        }
    }
    if let Some(logic) = logic {
        let other = operators
            .iter()
            .find(|operator| is_logic(operator) && *operator != logic);
        if let Some(other) = other {
            return pair(logic, other);
        }
    }
    operators
        .split(|operator| is_logic(operator))
        .find_map(|run| {
            let mut relations = run.iter().filter(|operator| is_relation(operator));
            pair(relations.next()?, relations.next()?)
        })
}

fn is_logic(token: &str) -> bool {
    ["&&", "||"].contains(&token)
}

fn is_relation(token: &str) -> bool {
    ["<", ">", "<=", ">=", "==", "!="].contains(&token)
}

fn is_operator(token: &str) -> bool {
    let others = [
        "+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>", "!", "~", ".",
    ];
    // A member access binds closer than any operator and is part of its operand.
    (others.contains(&token) && token != ".") || is_relation(token) || is_logic(token)
}

const PUNCTUATION: [&str; 23] = [
    "<<=", ">>=", "->", "&&", "||", "<<", ">>", "<=", ">=", "==", "!=", "+=", "-=", "*=", "/=",
    "%=", "&=", "|=", "^=", "++", "--", "//", "/*",
];

/// Returns words, numbers and punctuation, line by line, without comments. The angle brackets of template lists become
/// `template<` and `>template`.
fn tokens_of_lines(source: &str) -> Vec<Vec<String>> {
    let mut lines = Vec::new();
    let mut comment_depth = 0;
    for line in source.lines() {
        let mut tokens: Vec<String> = Vec::new();
        let mut rest = line;
        while let Some(first) = rest.chars().next() {
            if comment_depth > 0 {
                let length = if rest.starts_with("*/") {
                    comment_depth -= 1;
                    2
                } else if rest.starts_with("/*") {
                    comment_depth += 1;
                    2
                } else {
                    first.len_utf8()
                };
                rest = &rest[length..];
                continue;
            }
            if first.is_whitespace() {
                rest = &rest[first.len_utf8()..];
                continue;
            }
            let is_word = |c: char| c.is_alphanumeric() || c == '_';
            let length = if is_word(first) {
                word_length(rest)
            } else {
                let long = PUNCTUATION.iter().find(|long| rest.starts_with(**long));
                long.map_or(first.len_utf8(), |long| long.len())
            };
            let token = &rest[..length];
            rest = &rest[length..];
            match token {
                "//" => break,
                "/*" => comment_depth += 1,
                _ => tokens.push(token.to_owned()),
            }
        }
        lines.push(tokens);
    }
    mark_templates(&mut lines);
    lines
}

/// Returns the length of the word or number at the start of a text; a number may contain a point and the sign of its
/// exponent.
fn word_length(text: &str) -> usize {
    let is_number = text.starts_with(|c: char| c.is_ascii_digit());
    let is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    let mut before = ' ';
    let mut length = 0;
    for c in text.chars() {
        let exponent = if is_hexadecimal { "pP" } else { "eE" };
        let is_sign = "+-".contains(c) && is_number && exponent.contains(before);
        if !(c.is_alphanumeric() || c == '_' || (is_number && c == '.') || is_sign) {
            break;
        }
        before = c;
        length += c.len_utf8();
    }
    length
}

/// Applies WGSL's own rule (template list discovery): a `<` after a name begins a template list if its `>` comes before
/// any token that cannot be in one, with brackets in between skipped.
fn mark_templates(lines: &mut [Vec<String>]) {
    // This puts all tokens into one list, and splits each `>>` and `>=` that may close a list.
    let mut open: Vec<(usize, usize, usize)> = Vec::new();
    let mut depth = 0;
    let mut last_word = false;
    for line in 0..lines.len() {
        let mut at = 0;
        while at < lines[line].len() {
            let token = lines[line][at].clone();
            let closes = open.last().is_some_and(|(_, _, level)| *level == depth);
            match token.as_str() {
                "<" if last_word => open.push((line, at, depth)),
                ">" | ">>" | ">=" if closes => {
                    let (from_line, from, _) = open.pop().expect("an open list");
                    lines[from_line][from] = "template<".to_owned();
                    let rest = token[1..].to_owned();
                    lines[line][at] = ">template".to_owned();
                    if !rest.is_empty() {
                        lines[line].insert(at + 1, rest);
                    }
                }
                "(" | "[" => depth += 1,
                ")" | "]" => {
                    open.retain(|(_, _, level)| *level < depth);
                    depth -= 1;
                }
                "&&" | "||" => open.retain(|(_, _, level)| *level < depth),
                ";" | "{" | ":" | "=" => open.clear(),
                _ => {}
            }
            last_word = token.starts_with(|c: char| c.is_alphabetic() || c == '_');
            at += 1;
        }
    }
}

#[test]
fn operators_that_want_parentheses() {
    let refused = [
        "let bits = cell.x * 7u ^ cell.y * 3u;",
        "let a = b & c | d;",
        "let a = b & c == d;",
        "let a = b == c & d;",
        "let a = b & c && d;",
        "let a = b << c << d;",
        "let a = b << c + d;",
        "let a = b * c >> d;",
        "let a = b >> 2u ^ c;",
        "let a = b && c || d;",
        "let a = b || c && d;",
        "let a = b < c == d;",
        "let a = b < c < d;",
        "return b & c + d;",
        "if a && b || c { }",
        "x = f(a, b & c | d);",
        "x = y[a * b ^ c];",
        "x += a ^ b - c;",
        "let a = array<u32, 4>(b * c ^ d, 0u, 0u, 0u);",
        "let a = array<u32, 4>(0u, 0u, 0u, 0u)[0] * b ^ c;",
        "let a = b *\n    c ^ d;",
        "let a = -b * c ^ d;",
        "let a = b.x * c ^ d;",
        "let a = (b) * c ^ d;",
        "let a = b /* ( */ * c ^ d;",
        "for (var i = 0u; i < n * 2u & 3u; i++) { }",
        "let a = x - 1e-4 & y;",
    ];
    for line in refused {
        assert_eq!(mixed_operators(line).len(), 1, "{line}");
    }
    let accepted = [
        "let bits = (cell.x * 7u) ^ (cell.y * 3u);",
        "let a = b & c & d;",
        "let a = b ^ c ^ -d;",
        "let a = ~b & !c;",
        "let a = (b & c) == d;",
        "let a = b << 2u == c >> 3u;",
        "let a = (b << c) + d;",
        "let a = b && c && d;",
        "let a = (b && c) || d;",
        "let a = b < c && d >= e && f;",
        "let a = b + c * d - e / f % g < h;",
        "let a = array<vec4<f32>, 4>(b, c, d, e);",
        "var<storage, read_write> a: array<atomic<u32>>;",
        "@group(0) @binding(1) var<uniform> a: array<vec4<f32>, 2>;",
        "let a = f(b & c, d | e);",
        "let a = b * c; let d = e ^ f;",
        "if a < b { x = c > d; }",
        "let a = b * c; // d ^ e",
        "let a = b /* * c */ ^ d;",
        "let a = f(b < c, d >= e);",
        "switch (index - 8u) >> 2u { case 0u: { return a; } default: { return b; } }",
        "let a = vec3<u32>(index & 3u, (index >> 2u) & 3u, index >> 4u);",
        "let a: vec2<u32> = b & c;",
        "fn f(a: ptr<function, vec2<f32>>) -> vec2<u32> { return b ^ c; }",
        "for (var i = 0u; i < 4u && a < 1.0; i++) { b += c * d; }",
        "x = y * *z;",
        "let a = 1e-4 * b;",
        "let a = 0x9e3779b1u;",
    ];
    for line in accepted {
        assert_eq!(mixed_operators(line), [""; 0], "{line}");
    }
}
