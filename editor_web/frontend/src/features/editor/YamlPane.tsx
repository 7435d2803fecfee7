/** The document as text, in step with the canvas: typing changes the graph, edits on the canvas change the text in place. */
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from '@codemirror/autocomplete'
import { defaultKeymap, indentWithTab } from '@codemirror/commands'
import { yaml } from '@codemirror/lang-yaml'
import { bracketMatching, foldGutter, HighlightStyle, indentOnInput, indentUnit, syntaxHighlighting } from '@codemirror/language'
import { lintGutter, setDiagnostics, type Diagnostic } from '@codemirror/lint'
import { highlightSelectionMatches, search, searchKeymap } from '@codemirror/search'
import { Annotation, EditorState, StateEffect, StateField } from '@codemirror/state'
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
import { Box } from '@mantine/core'
import { useEffect, useRef } from 'react'
import type { FindingView, FixesBody } from '../../api/types'
import { isError, problemsOf } from '../../document/editing/findings'
import { changeBetween } from '../../document/editing/textChange'
import { nodeAtLine } from '../../document/editing/textPositions'
import { typed } from './apply'
import { fixesOf, makeFix, useFreshFixes } from './fixes'
import { completeText } from './textCompletion'
import { TEXT_FRAME } from './textFrame'
import { choose } from './actions'
import { chosenOf, draftOf, editor, rootOf, setEditor, useEditor } from './store'

/** A change that comes from the canvas, not from the keyboard. */
const FromCanvas = Annotation.define<boolean>()

const markNode = StateEffect.define<{ from: number; to: number } | undefined>()

/** The lines of the selected node. */
const nodeLines = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(lines, transaction) {
    const next = lines.map(transaction.changes)
    const effect = transaction.effects.find((each) => each.is(markNode))
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

function newView(parent: HTMLElement): EditorView {
  return new EditorView({
    parent,
    state: EditorState.create({
      doc: draftOf(editor()).text,
      extensions: [
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
        nodeLines,
        TEXT_FRAME,
        yaml(),
        syntaxHighlighting(LOOK),
        autocompletion({ override: [completeText], activateOnTyping: true }),
        // No history of its own: undo is that of the document.
        keymap.of([
          ...closeBracketsKeymap,
          ...completionKeymap,
          ...searchKeymap.filter((binding) => binding.key !== 'Mod-d'),
          ...defaultKeymap,
          indentWithTab,
        ]),
        EditorView.contentAttributes.of({ 'aria-label': 'Text of the behavior', tabindex: '0' }),
        EditorView.updateListener.of((update) => {
          const isOwn = !update.transactions.some((each) => each.annotation(FromCanvas))
          if (update.docChanged && isOwn) typed(update.state.doc.toString())
          else if (update.selectionSet && isOwn && update.view.hasFocus) follow(update.state)
        }),
      ],
    }),
  })
}

/** The cursor goes into another node's lines: that one is chosen. */
function follow(state: EditorState): void {
  const root = rootOf(editor())
  const { isStale } = draftOf(editor())
  if (!root || isStale) return
  const node = nodeAtLine(root, state.doc.lineAt(state.selection.main.head).number)
  if (node && node.path !== 'root' && editor().selection.at(-1) !== node.path) {
    choose([node.path])
    setEditor({ shown: { path: node.path } })
  }
}

function diagnosticsOf(view: EditorView, findings: readonly FindingView[], fixes: readonly FixesBody[]): Diagnostic[] {
  const { doc } = view.state
  return findings
    .map((finding) => {
      const line = doc.line(Math.max(1, Math.min(doc.lines, finding.line)))
      const from = Math.min(line.to, line.from + Math.max(0, finding.column - 1))
      const word = /^[^\s,:}\]]+/.exec(doc.sliceString(from, line.to))?.[0].length ?? 1
      return {
        from,
        to: Math.min(line.to, from + Math.max(1, word)),
        severity: isError(finding) ? ('error' as const) : ('warning' as const),
        message: [finding.message, finding.hint].filter(Boolean).join('\n'),
        source: finding.code,
        actions: fixesOf(fixes, finding).map((fix) => ({
          name: fix.title.replaceAll('`', ''),
          apply: () => makeFix(fix),
        })),
      }
    })
    .toSorted((a, b) => a.from - b.from)
}

export function YamlPane() {
  const host = useRef<HTMLDivElement>(null)
  const view = useRef<EditorView>(null)
  const text = useEditor((s) => draftOf(s).text)
  const findings = useEditor((s) => problemsOf(draftOf(s)))
  const fixes = useFreshFixes()
  const chosen = useEditor(chosenOf)
  const place = useEditor((s) => s.place)

  useEffect(() => {
    if (!host.current) return
    const made = newView(host.current)
    view.current = made
    return () => made.destroy()
  }, [])

  useEffect(() => {
    const change = view.current && changeBetween(view.current.state.doc.toString(), text)
    if (change) view.current?.dispatch({ changes: change, annotations: FromCanvas.of(true) })
  }, [text])

  useEffect(() => {
    const now = view.current
    if (now) now.dispatch(setDiagnostics(now.state, diagnosticsOf(now, findings, fixes)))
  }, [findings, fixes, text])

  useEffect(() => {
    const now = view.current
    if (!now) return
    const lines =
      chosen && chosen.line <= now.state.doc.lines ? { from: chosen.line, to: Math.max(chosen.line, chosen.end_line) } : undefined
    const at = lines && now.state.doc.line(lines.from).from
    const effects: StateEffect<unknown>[] = [markNode.of(lines)]
    if (at !== undefined && !now.hasFocus) effects.push(EditorView.scrollIntoView(at, { y: 'start', yMargin: 60 }))
    now.dispatch({ effects })
    // oxlint-disable-next-line react/exhaustive-deps -- a node that was drawn anew, with the same lines, scrolls nothing
  }, [chosen?.line, chosen?.end_line, chosen?.path, text])

  useEffect(() => {
    const now = view.current
    if (!now || !place) return
    const line = now.state.doc.line(Math.max(1, Math.min(now.state.doc.lines, place.line)))
    const at = Math.min(line.to, line.from + Math.max(0, place.column - 1))
    now.dispatch({
      selection: { anchor: at },
      effects: EditorView.scrollIntoView(at, { y: 'center' }),
      annotations: FromCanvas.of(true),
    })
  }, [place])

  return <Box component="section" h="100%" mih={0} bg="var(--surface)" style={{ overflow: 'hidden' }} aria-label="Text" ref={host} />
}
