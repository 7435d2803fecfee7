/** The names that the document's own cell offers, asked for when the document names another one. */
import { documents } from '../../api/documents'
import { mayAsk } from './checking'
import { draftOf, editor, setEditor } from './store'

let asked = ''

export async function lookForNames(): Promise<void> {
  const { id } = editor()
  const { text, document, isStale } = draftOf(editor())
  const cell = document?.cell
  const of = `${id} ${cell ?? ''}`
  if (isStale || of === asked || !id) return
  asked = of
  if (!cell) {
    setEditor({ names: undefined })
    return
  }
  if (!(await mayAsk())) return
  try {
    const names = await documents.names(id, text)
    if (asked === of && editor().id === id) setEditor({ names })
  } catch {
    // The names of the open cell stand in; the next text asks again.
    asked = ''
  }
}
