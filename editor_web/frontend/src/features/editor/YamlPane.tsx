/** The document as text, in step with the canvas: typing changes the graph, edits on the canvas change the text in place. */
import { autocompletion } from '@codemirror/autocomplete'
import { setDiagnostics, type Diagnostic } from '@codemirror/lint'
import { EditorState } from '@codemirror/state'
import { EditorView } from '@codemirror/view'
import { Box } from '@mantine/core'
import { useEffect, useRef } from 'react'
import type { FindingView, FixesBody } from '../../api/types'
import { diagnosticOf, FromPage, showLines, showText, yamlText } from '../../components/yamlText'
import { problemsOf } from '../../document/editing/findings'
import { nodeAtLine } from '../../document/editing/textPositions'
import { typed } from './apply'
import { fixesOf, makeFix, useFreshFixes } from './fixes'
import { completeText } from './textCompletion'
import { choose } from './actions'
import { chosenOf, draftOf, editor, rootOf, setEditor, useEditor } from './store'

function newView(parent: HTMLElement): EditorView {
  return new EditorView({
    parent,
    state: EditorState.create({
      doc: draftOf(editor()).text,
      extensions: [
        yamlText('Text of the behavior'),
        autocompletion({ override: [completeText], activateOnTyping: true }),
        EditorView.updateListener.of((update) => {
          const isOwn = !update.transactions.some((each) => each.annotation(FromPage))
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
  return findings
    .map((finding) => ({
      ...diagnosticOf(view, finding),
      actions: fixesOf(fixes, finding).map((fix) => ({
        name: fix.title.replaceAll('`', ''),
        apply: () => makeFix(fix),
      })),
    }))
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
    if (view.current) showText(view.current, text)
  }, [text])

  useEffect(() => {
    const now = view.current
    if (now) now.dispatch(setDiagnostics(now.state, diagnosticsOf(now, findings, fixes)))
  }, [findings, fixes, text])

  useEffect(() => {
    const now = view.current
    if (!now) return
    const isThere = chosen && chosen.line <= now.state.doc.lines
    showLines(now, isThere ? { from: chosen.line, to: Math.max(chosen.line, chosen.end_line) } : undefined)
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
      annotations: FromPage.of(true),
    })
  }, [place])

  return <Box component="section" h="100%" mih={0} bg="var(--surface)" style={{ overflow: 'hidden' }} aria-label="Text" ref={host} />
}
