/** A Python text with line numbers, to be read only; the lines of the class are marked and in view. */
import { search, searchKeymap } from '@codemirror/search'
import { EditorState } from '@codemirror/state'
import { Decoration, EditorView, keymap, lineNumbers } from '@codemirror/view'
import { Box } from '@mantine/core'
import { useEffect, useRef } from 'react'
import type { StateSource } from '../../api/types'
import { TEXT_FRAME } from '../../components/textFrame'

export function SourceText({ source }: { readonly source: StateSource }) {
  const parent = useRef<HTMLDivElement>(null)
  useEffect(() => {
    const element = parent.current
    if (!element) return undefined
    const view = newView(element, source)
    return () => view.destroy()
  }, [source])
  return <Box ref={parent} h="60vh" style={{ overflow: 'hidden', border: '1px solid var(--line)' }} />
}

function newView(parent: HTMLElement, { text, line, end_line, file }: StateSource): EditorView {
  const state = EditorState.create({
    doc: text,
    extensions: [
      lineNumbers(),
      search({ top: true }),
      keymap.of(searchKeymap),
      TEXT_FRAME,
      EditorState.readOnly.of(true),
      EditorView.editable.of(false),
      EditorView.contentAttributes.of({ 'aria-label': `Source in ${file}`, role: 'textbox', 'aria-readonly': 'true', tabindex: '0' }),
      EditorView.decorations.of((view) => {
        const { doc } = view.state
        const lines = Array.from({ length: Math.min(end_line, doc.lines) - line + 1 }, (_, index) => doc.line(line + index))
        return Decoration.set(lines.map(({ from }) => Decoration.line({ class: 'cm-node-line' }).range(from)))
      }),
    ],
  })
  const view = new EditorView({ parent, state })
  const start = view.state.doc.line(Math.min(line, view.state.doc.lines)).from
  view.dispatch({ selection: { anchor: start }, effects: EditorView.scrollIntoView(start, { y: 'start', yMargin: 40 }) })
  return view
}
