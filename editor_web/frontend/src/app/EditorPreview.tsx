/** Named entries as the editor shows them in 3D: the view of the cell, and what is known of the entry. */
import { useEffect } from 'react'
import { showPreview, usePreview } from '../api/preview'
import { CellFrame } from '../features/cell/CellFrame'
import { ShowMenu } from '../features/cell/ShowMenu'
import { EntryPreview } from '../features/preview/EntryPreview'

export function EditorPreview({ isNarrow }: { readonly isNarrow: boolean }) {
  const shown = usePreview((s) => s.shown)
  useEffect(() => () => showPreview(undefined), [])
  if (!shown) return null
  return (
    <EntryPreview
      shown={shown}
      isSheet={isNarrow}
      view={<CellFrame />}
      // A sheet lies over everything, also over the menu.
      tools={isNarrow ? null : <ShowMenu />}
      onClose={() => showPreview(undefined)}
    />
  )
}
