//! Reads rung text.

use instr::{Form, Instruction as Entry, Kind, TextLevel};
use ladder::{Branch, Element, Expression, Family, Instruction, Mnemonic, Operand, Rung, Series};

use super::error::TextError;
use super::operand::{self, Keyword};
use super::token::{Token, tokens};

/// Branches nest at most this deep in text. Programs were seen to nest four deep; the limit keeps
/// hostile text from building a tree that is too deep to walk.
pub const MAX_BRANCH_DEPTH: usize = 64;

/// Reads one rung, with or without `SOR` and `EOR` around it.
///
/// `family` decides between the forms of an instruction that processors write differently (OSR);
/// without it the number of operands that follow decides.
///
/// # Errors
/// The first word that does not fit, with its place and what belongs there.
///
/// ```
/// use convert::slc::rung::{parse_rung, rung_text};
///
/// let rung = parse_rung("xic B3/17 BST OTE O:2/0 NXB TON T4:0 1.0 60 0 BND", None)?;
/// assert_eq!(rung_text(&rung), "XIC B3:1/1 BST OTE O:2.0/0 NXB TON T4:0 1.0 60 0 BND");
/// # Ok::<(), convert::slc::rung::TextError>(())
/// ```
pub fn parse_rung(text: &str, family: Option<Family>) -> Result<Rung, TextError> {
    parse_rung_at(text, family, 1)
}

/// As [`parse_rung`], for a text whose first line is line `first_line` of its file: errors count
/// lines from there.
///
/// # Errors
/// As [`parse_rung`].
pub fn parse_rung_at(text: &str, family: Option<Family>, first_line: u32) -> Result<Rung, TextError> {
    let tokens = tokens(text, first_line)?;
    let mut parser = Parser::new(&tokens, family);
    let rung = parser.rung()?;
    match parser.peek() {
        None => Ok(rung),
        Some(token) => Err(error(token).expected("the end of the rung")),
    }
}

/// Reads a list of rungs: each in a line of its own, or framed by `SOR` and `EOR`, which may then
/// span lines. Empty lines and lines that are `% comments %` are passed over.
///
/// # Errors
/// Every rung that cannot be read, in order of their lines.
pub fn parse_rungs(text: &str, family: Option<Family>) -> Result<Vec<Rung>, Vec<TextError>> {
    let (mut rungs, mut errors) = (Vec::new(), Vec::new());
    for (first_line, chunk) in chunks(text) {
        match chunk_rungs(chunk, family, first_line) {
            Ok(mut found) => rungs.append(&mut found),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok(rungs) } else { Err(errors) }
}

/// Pieces of whole rungs with the line each starts in: single lines, and lines from one that starts
/// with `SOR` to the one that ends with `EOR`.
fn chunks(text: &str) -> Vec<(u32, &str)> {
    let mut found = Vec::new();
    let mut open: Option<(u32, usize)> = None;
    let mut at = 0;
    for (number, line) in (1_u32..).zip(text.split_inclusive('\n')) {
        let end = at + line.len();
        let words = line.trim();
        let framed = |word: Option<&str>, frame: &str| word.is_some_and(|word| word.eq_ignore_ascii_case(frame));
        let ends = framed(words.rsplit(char::is_whitespace).next(), "EOR");
        match open {
            Some((first, start)) if ends => {
                found.push((first, start..end));
                open = None;
            }
            Some(_) => {}
            None if words.is_empty() || (words.starts_with('%') && words.ends_with('%')) => {}
            None if !ends && framed(words.split(char::is_whitespace).next(), "SOR") => open = Some((number, at)),
            None => found.push((number, at..end)),
        }
        at = end;
    }
    if let Some((first, start)) = open {
        found.push((first, start..text.len()));
    }
    found.into_iter().map(|(line, range)| (line, text.get(range).unwrap_or(""))).collect()
}

fn chunk_rungs(text: &str, family: Option<Family>, first_line: u32) -> Result<Vec<Rung>, TextError> {
    let tokens = tokens(text, first_line)?;
    let mut parser = Parser::new(&tokens, family);
    let mut rungs = Vec::new();
    while parser.peek().is_some() {
        rungs.push(parser.rung()?);
    }
    Ok(rungs)
}

fn error(token: &Token<'_>) -> TextError {
    TextError::at(token.line, token.column, &token.text)
}

struct Parser<'t, 'a> {
    tokens: &'t [Token<'a>],
    at: usize,
    family: Option<Family>,
    /// The instruction read last and its form, for errors about surplus operands.
    last: Option<(&'static Entry, &'static Form)>,
}

/// An open branch: legs that are complete, and the series the branch stands in.
struct Open {
    legs: Vec<Series>,
    outer: Series,
}

impl<'t, 'a> Parser<'t, 'a> {
    fn new(tokens: &'t [Token<'a>], family: Option<Family>) -> Self {
        Parser { tokens, at: 0, family: family.filter(|family| *family != Family::Unknown), last: None }
    }

    fn peek(&self) -> Option<&'t Token<'a>> {
        self.tokens.get(self.at)
    }

    /// An error at the next word, or behind the last one.
    fn error(&self) -> TextError {
        match (self.peek(), self.tokens.last()) {
            (Some(token), _) => error(token),
            (None, Some(last)) => {
                let length = u32::try_from(last.text.chars().count()).unwrap_or(u32::MAX);
                TextError::at(last.line, last.column.saturating_add(length), "")
            }
            (None, None) => TextError::at(1, 1, ""),
        }
    }

    fn rung(&mut self) -> Result<Rung, TextError> {
        let framed = self.peek().is_some_and(|token| token.is("SOR"));
        self.at += usize::from(framed);
        let mut open: Vec<Open> = Vec::new();
        let mut series = Series::new();
        loop {
            let Some(token) = self.peek() else {
                let end = match (open.is_empty(), framed) {
                    (false, _) => "BND",
                    (true, true) => "EOR",
                    (true, false) => return Ok(Rung::new(exact(series))),
                };
                return Err(self.error().expected(end));
            };
            let word = if token.quoted { None } else { operand::keyword(&token.text) };
            match word {
                Some(Keyword::Structure("BST")) => {
                    if open.len() >= MAX_BRANCH_DEPTH {
                        let limit = format!("branches nested at most {MAX_BRANCH_DEPTH} deep");
                        return Err(error(token).expected(limit));
                    }
                    open.push(Open { legs: Vec::new(), outer: std::mem::take(&mut series) });
                }
                Some(Keyword::Structure("NXB")) => match open.last_mut() {
                    Some(branch) => branch.legs.push(exact(std::mem::take(&mut series))),
                    None => return Err(error(token).expected("a BST before NXB")),
                },
                Some(Keyword::Structure("BND")) => match open.pop() {
                    Some(Open { mut legs, mut outer }) => {
                        legs.push(exact(series));
                        outer.push(Element::Branch(Branch { legs }));
                        series = outer;
                    }
                    None => return Err(error(token).expected("a BST before BND")),
                },
                Some(Keyword::Structure("EOR")) if open.is_empty() => {
                    self.at += 1;
                    return Ok(Rung::new(exact(series)));
                }
                Some(Keyword::Structure("EOR")) => return Err(error(token).expected("BND before the end of the rung")),
                Some(Keyword::Structure(_)) => return Err(error(token).expected("EOR before the next rung")),
                _ => {
                    series.push(Element::Instruction(self.instruction()?));
                    continue;
                }
            }
            self.last = None;
            self.at += 1;
        }
    }

    fn instruction(&mut self) -> Result<Instruction, TextError> {
        let Some(token) = self.peek() else { return Err(self.error().expected("an instruction")) };
        let name = token.text.strip_suffix('(').unwrap_or(&token.text);
        let keyword = if token.quoted { None } else { operand::keyword(name) };
        let mnemonic = match &keyword {
            Some(Keyword::Known(entry)) => Mnemonic::named(entry.mnemonic),
            Some(Keyword::Code(code)) => Mnemonic::Unknown(*code),
            Some(Keyword::Structure(_)) | None => return Err(self.not_an_instruction(token)),
        };
        self.at += 1;
        let mut grouped = name.len() < token.text.len();
        if !grouped && self.peek().is_some_and(|next| next.is("(")) {
            self.at += 1;
            grouped = true;
        }
        let operands = match keyword {
            _ if grouped => self.group()?,
            Some(Keyword::Known(entry)) => self.operands(entry)?,
            _ => {
                let parentheses = format!("`{mnemonic}(`, the operands, `)`, separated by blanks");
                return Err(error(token).expected(parentheses));
            }
        };
        Ok(Instruction::new(mnemonic, operands))
    }

    fn not_an_instruction(&self, token: &Token<'_>) -> TextError {
        let expected = match self.last {
            Some((entry, form)) => format!("an instruction after {}, which has {}", entry.mnemonic, operand_list(form)),
            None => "an instruction".to_owned(),
        };
        let error = error(token).expected(expected);
        // What looks like an address is a surplus operand, not a misspelled mnemonic.
        if token.text.contains([':', '/', '.', '#']) { error } else { error.suggest() }
    }

    /// Operands in parentheses: all of them, spelled as stored.
    fn group(&mut self) -> Result<Vec<Operand>, TextError> {
        let mut operands = Vec::new();
        self.last = None;
        loop {
            match self.peek() {
                Some(token) if token.is(")") => {
                    self.at += 1;
                    return Ok(operands);
                }
                Some(token) if token.quoted || !operand::is_reserved(&token.text) => {
                    operands.push(operand::read(token, None));
                    self.at += 1;
                }
                _ => return Err(self.error().expected("an operand or `)`")),
            }
        }
    }

    /// Words that can be operands, from here on, counted up to `most`.
    fn operand_run(&self, most: usize) -> usize {
        let rest = self.tokens.get(self.at..).unwrap_or(&[]);
        rest.iter().take(most).take_while(|t| t.quoted || !operand::is_reserved(&t.text)).count()
    }

    /// Operands without parentheses: as many as the form has.
    fn operands(&mut self, entry: &'static Entry) -> Result<Vec<Operand>, TextError> {
        let mut forms: Vec<&'static Form> = match self.family {
            Some(family) => entry.forms_for(family).collect(),
            None => Vec::new(),
        };
        if forms.is_empty() {
            // An instruction this processor does not have: the program must still be readable.
            forms = entry.forms.iter().collect();
        }
        let form = match self.choose(&forms) {
            Choice::Form(form) => form,
            Choice::Verbatim => {
                let operands = self.operand_run(usize::MAX);
                let taken = self.tokens.get(self.at..self.at + operands).unwrap_or(&[]);
                self.at += operands;
                return Ok(taken.iter().map(|token| operand::read(token, None)).collect());
            }
            Choice::None => return Ok(Vec::new()),
        };
        let mut operands = Vec::with_capacity(form.operands.len());
        for spec in form.operands {
            operands.push(match spec.kind {
                _ if !spec.in_text() => Operand::Empty,
                Kind::Expression => self.expression(entry, form, spec.name)?,
                kind => match self.peek() {
                    Some(token) if token.quoted || !operand::is_reserved(&token.text) => {
                        self.at += 1;
                        operand::read(token, Some(kind))
                    }
                    _ => return Err(self.missing(entry, form, spec.name)),
                },
            });
        }
        self.last = Some((entry, form));
        Ok(operands)
    }

    /// The form the words that follow can be.
    fn choose(&self, forms: &[&'static Form]) -> Choice {
        let Some(first) = forms.first() else { return Choice::None };
        let open = forms.iter().any(|form| form.text == TextLevel::Unknown);
        if !open && forms.iter().all(|form| text_count(form) == text_count(first)) {
            return Choice::Form(first);
        }
        let most = forms.iter().map(|form| text_count(form)).max().unwrap_or(0);
        let run = self.operand_run(most + 1);
        if let Some(form) = forms.iter().find(|form| text_count(form) == run) {
            return Choice::Form(form);
        }
        if open {
            return Choice::Verbatim;
        }
        // None fits: report against the longest form that the words would fill, else the shortest.
        let filled = forms.iter().filter(|form| text_count(form) < run).max_by_key(|form| text_count(form));
        let nearest = filled.or_else(|| forms.iter().min_by_key(|form| text_count(form)));
        nearest.map_or(Choice::None, |form| Choice::Form(form))
    }

    fn missing(&self, entry: &Entry, form: &Form, operand: &str) -> TextError {
        self.error().expected(format!("{operand} of {}, which has {}", entry.mnemonic, operand_list(form)))
    }

    fn expression(&mut self, entry: &Entry, form: &Form, name: &str) -> Result<Operand, TextError> {
        if let Some(token) = self.peek().filter(|token| token.quoted) {
            self.at += 1;
            return Ok(operand::read(token, None));
        }
        let words = self.expression_words();
        let texts: Vec<&str> = words.iter().map(|(_, text)| *text).collect();
        let behind = words.last().map_or(self.at, |last| last.0 + 1);
        let more = self.tokens.get(behind).is_some_and(|token| token.quoted);
        match read_expression(&texts, more) {
            Ok((expression, used)) => {
                // An expression ends with a whole word, or else a parenthesis closes too much.
                let next = words.get(used).map_or(behind, |word| word.0);
                if used > 0 && words.get(used - 1).is_some_and(|last| last.0 == next) {
                    let surplus = self.tokens.get(next).map_or_else(|| self.error(), error);
                    return Err(surplus.expected(format!("the end of the expression of {}", entry.mnemonic)));
                }
                self.at = next;
                Ok(Operand::Expression(expression))
            }
            Err(_) if words.is_empty() => Err(self.missing(entry, form, name)),
            Err(wrong) => {
                self.at = words.get(wrong.token).map_or(behind, |word| word.0);
                Err(self.error().expected(format!("{} in the expression of {}", wrong.expected, entry.mnemonic)))
            }
        }
    }

    /// Words that an expression can be made of, parentheses apart from what they touch, each with
    /// the number of its token.
    fn expression_words(&self) -> Vec<(usize, &'t str)> {
        let mut words = Vec::new();
        for (number, token) in self.tokens.iter().enumerate().skip(self.at) {
            if token.quoted || words.len() >= operand::MAX_EXPRESSION || !operand::expression_word(&token.text) {
                break;
            }
            let mut rest = token.text.as_ref();
            while let Some(at) = rest.find(['(', ')']) {
                let (before, from) = rest.split_at(at);
                let (parenthesis, after) = from.split_at(1);
                words.extend([before, parenthesis].into_iter().filter(|w| !w.is_empty()).map(|w| (number, w)));
                rest = after;
            }
            if !rest.is_empty() {
                words.push((number, rest));
            }
        }
        words
    }
}

/// Without the room a growing list keeps; most rungs are short and a program has many.
fn exact(mut series: Series) -> Series {
    series.shrink_to_fit();
    series
}

enum Choice {
    Form(&'static Form),
    /// What RSLogix writes for this instruction is not known: take what stands there.
    Verbatim,
    None,
}

fn text_count(form: &Form) -> usize {
    form.operands.iter().filter(|operand| operand.in_text()).count()
}

/// `the operands Timer, Time Base, Preset, Accum`.
fn operand_list(form: &Form) -> String {
    let names: Vec<&str> = form.operands.iter().filter(|o| o.in_text()).map(|o| o.name).collect();
    match names.as_slice() {
        [] => "no operands".to_owned(),
        [one] => format!("the operand {one}"),
        many => format!("the operands {}", many.join(", ")),
    }
}

/// Reads the expression `words` begin with. `more`: a quoted operand follows them.
///
/// AND, OR and XOR are operators and instructions. As an operator the word is followed by one value,
/// as an instruction by three operands, after which the next instruction begins: so when something
/// is left over, such a word at the outer level that has three values behind it is an instruction.
fn read_expression(words: &[&str], more: bool) -> Result<(Expression, usize), ladder::ExpressionError> {
    let whole = Expression::parse_prefix(words);
    if !more && whole.as_ref().is_ok_and(|(_, used)| *used == words.len()) {
        return whole;
    }
    let mut depth = 0_usize;
    for (at, word) in words.iter().enumerate() {
        match *word {
            "(" => depth += 1,
            ")" => depth = depth.saturating_sub(1),
            _ if depth == 0 && at > 0 && ["AND", "OR", "XOR"].iter().any(|name| name.eq_ignore_ascii_case(word)) => {
                let rest = words.get(at + 1..).unwrap_or(&[]);
                let is_value = |word: &&&str| !operand::is_shared(word) && !matches!(**word, "(" | ")");
                let values = rest.iter().take(4).take_while(is_value).count();
                let ends = rest.len() == values;
                let continues = rest.get(3).is_some_and(|next| operand::is_shared(next));
                // Quoted operands end the words early: fewer than three are left then.
                if (values == 3 && (ends || continues)) || (values < 3 && ends && more) {
                    return Expression::parse_prefix(words.get(..at).unwrap_or(&[]));
                }
            }
            _ => {}
        }
    }
    whole
}
