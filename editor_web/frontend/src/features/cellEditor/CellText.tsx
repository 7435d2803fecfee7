/** The document under edit as text, in step with the tree: the cursor selects its item, an edit changes the text in place. */
import { setDiagnostics } from '@codemirror/lint'
import { EditorState } from '@codemirror/state'
import { EditorView, keymap } from '@codemirror/view'
import { Box } from '@mantine/core'
import { useEffect, useRef } from 'react'
import { diagnosticOf, FromPage, showLines, showText, yamlText } from '../../components/yamlText'
import { itemAddress, itemAt, itemAtLine } from '../../document/cellEditing'
import { redo, typed, undo } from './session'
import { cellEditor, draftOf, useCellEditor } from './store'

interface CellTextProps {
  /** The address of the selected item. */
  readonly selected: string
  readonly onSelect: (address: string) => void
}

export function CellText({ selected, onSelect }: CellTextProps) {
  const host = useRef<HTMLDivElement>(null)
  const view = useRef<EditorView>(null)
  const draft = useCellEditor(draftOf)
  const item = itemAt(draft, selected)
  const select = useRef(onSelect)
  const shown = useRef(selected)
  useEffect(() => {
    select.current = onSelect
    shown.current = selected
  })

  useEffect(() => {
    if (!host.current) return
    const made = newView(host.current, (address) => address !== shown.current && select.current(address))
    view.current = made
    return () => made.destroy()
  }, [])

  useEffect(() => {
    if (view.current) showText(view.current, draft.text)
  }, [draft.text])

  useEffect(() => {
    const now = view.current
    if (now) now.dispatch(setDiagnostics(now.state, draft.isStale ? [] : draft.findings.map((each) => diagnosticOf(now, each))))
  }, [draft])

  useEffect(() => {
    const now = view.current
    const isThere = item && item.end_line <= (now?.state.doc.lines ?? 0)
    if (now) showLines(now, isThere ? { from: item.line, to: item.end_line } : undefined)
    // oxlint-disable-next-line react/exhaustive-deps -- the same lines scroll nothing
  }, [item?.line, item?.end_line, selected, draft.text])

  return <Box component="section" h="100%" mih={0} bg="var(--surface)" style={{ overflow: 'hidden' }} aria-label="Text" ref={host} />
}

function newView(parent: HTMLElement, onItem: (address: string) => void): EditorView {
  const done = (act: () => unknown) => () => {
    act()
    return true
  }
  return new EditorView({
    parent,
    state: EditorState.create({
      doc: draftOf(cellEditor()).text,
      extensions: [
        keymap.of([
          { key: 'Mod-z', run: done(undo) },
          { key: 'Mod-y', run: done(redo) },
          { key: 'Mod-Shift-z', run: done(redo) },
        ]),
        yamlText('Text of the cell'),
        EditorView.updateListener.of((update) => {
          const isOwn = !update.transactions.some((each) => each.annotation(FromPage))
          if (update.docChanged && isOwn) typed(update.state.doc.toString())
          else if (update.selectionSet && isOwn && update.view.hasFocus) follow(update.state, onItem)
        }),
      ],
    }),
  })
}

function follow(state: EditorState, onItem: (address: string) => void): void {
  const draft = draftOf(cellEditor())
  if (draft.isStale) return
  const item = itemAtLine(draft, state.doc.lineAt(state.selection.main.head).number)
  if (item) onItem(itemAddress(item))
}
