/** The names that the document's own cell offers, asked for when the document names another one. */
import { documents } from '../../api/documents'
import { mayAsk } from './checking'
import { draftOf, editor, setEditor } from './store'

export async function lookForNames(): Promise<void> {
  const { id, namesOf } = editor()
  const { text, document, isStale } = draftOf(editor())
  const cell = document?.cell ?? ''
  if (isStale || cell === namesOf || !id) return
  setEditor({ namesOf: cell })
  if (!cell) {
    setEditor({ names: undefined })
    return
  }
  if (!(await mayAsk())) return
  const isCurrent = () => editor().id === id && editor().namesOf === cell
  try {
    const names = await documents.names(id, text)
    if (isCurrent()) setEditor({ names })
  } catch {
    // The names of the open cell stand in; the next text asks again.
    if (isCurrent()) setEditor({ namesOf: undefined })
  }
}
