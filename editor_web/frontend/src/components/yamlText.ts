/** YAML in CodeMirror as every page of this one shows it: its look, its keys, marked lines, and changes from elsewhere. */
import { closeBrackets, closeBracketsKeymap, completionKeymap } from '@codemirror/autocomplete'
import { defaultKeymap, indentWithTab } from '@codemirror/commands'
import { yaml } from '@codemirror/lang-yaml'
import { bracketMatching, foldGutter, HighlightStyle, indentOnInput, indentUnit, syntaxHighlighting } from '@codemirror/language'
import { lintGutter, type Diagnostic } from '@codemirror/lint'
import { highlightSelectionMatches, search, searchKeymap } from '@codemirror/search'
import { Annotation, StateEffect, StateField, type Extension } from '@codemirror/state'
import {
  Decoration,
  drawSelection,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  keymap,
  lineNumbers,
  type DecorationSet,
} from '@codemirror/view'
import { tags } from '@lezer/highlight'
import type { FindingView } from '../api/types'
import { changeBetween } from '../document/editing/textChange'
import { TEXT_FRAME } from './textFrame'

/** A change that comes from elsewhere on the page, not from the keyboard. */
export const FromPage = Annotation.define<boolean>()

export interface LineRange {
  readonly from: number
  readonly to: number
}

const markLines = StateEffect.define<LineRange | undefined>()

const markedLines = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(lines, transaction) {
    const next = lines.map(transaction.changes)
    const effect = transaction.effects.find((each) => each.is(markLines))
    if (!effect) return next
    if (!effect.value) return Decoration.none
    const { doc } = transaction.state
    const { from, to } = effect.value
    const marks = []
    for (let line = from; line <= Math.min(to, doc.lines); line += 1)
      marks.push(Decoration.line({ class: 'cm-node-line' }).range(doc.line(line).from))
    return Decoration.set(marks)
  },
  provide: (field) => EditorView.decorations.from(field),
})

const LOOK = HighlightStyle.define([
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: 'var(--accent)' },
  { tag: [tags.string, tags.content], color: 'var(--done)' },
  { tag: [tags.number, tags.bool, tags.null], color: 'var(--stopped)' },
  { tag: tags.comment, color: 'var(--quiet)' },
  { tag: [tags.punctuation, tags.separator, tags.brace, tags.squareBracket], color: 'var(--quiet)' },
])

/** All that the texts have in common. They have no history of their own: undo is that of the document. */
export function yamlText(label: string): Extension {
  return [
    lineNumbers(),
    foldGutter(),
    lintGutter(),
    highlightActiveLine(),
    highlightActiveLineGutter(),
    drawSelection(),
    indentOnInput(),
    indentUnit.of('  '),
    bracketMatching(),
    closeBrackets(),
    highlightSelectionMatches(),
    search({ top: true }),
    markedLines,
    TEXT_FRAME,
    yaml(),
    syntaxHighlighting(LOOK),
    keymap.of([
      ...closeBracketsKeymap,
      ...completionKeymap,
      ...searchKeymap.filter((binding) => binding.key !== 'Mod-d'),
      ...defaultKeymap,
      indentWithTab,
    ]),
    EditorView.contentAttributes.of({ 'aria-label': label, tabindex: '0' }),
  ]
}

/** Show a text in the place of the one that is shown; what stays keeps its cursor. */
export function showText(view: EditorView, text: string): void {
  const change = changeBetween(view.state.doc.toString(), text)
  if (change) view.dispatch({ changes: change, annotations: FromPage.of(true) })
}

/** Mark lines, and bring the first of them into sight unless somebody writes here. */
export function showLines(view: EditorView, lines: LineRange | undefined): void {
  const effects: StateEffect<unknown>[] = [markLines.of(lines)]
  if (lines && !view.hasFocus) effects.push(EditorView.scrollIntoView(view.state.doc.line(lines.from).from, { y: 'start', yMargin: 60 }))
  view.dispatch({ effects })
}

/** A finding at its word of the text. */
export function diagnosticOf(view: EditorView, finding: FindingView): Diagnostic {
  const { doc } = view.state
  const line = doc.line(Math.max(1, Math.min(doc.lines, finding.line)))
  const from = Math.min(line.to, line.from + Math.max(0, finding.column - 1))
  const word = /^[^\s,:}\]]+/.exec(doc.sliceString(from, line.to))?.[0].length ?? 1
  return {
    from,
    to: Math.min(line.to, from + Math.max(1, word)),
    severity: finding.severity === 'error' ? 'error' : 'warning',
    message: [finding.message, finding.hint].filter(Boolean).join('\n'),
    source: finding.code,
  }
}
