/** The menus of the 3D view on the first page, which shows the view before them. */
import { HandleMenu } from '../features/cell/HandleMenu'
import { ShowMenu } from '../features/cell/ShowMenu'

export function CellMenus({ mayOperate }: { readonly mayOperate: boolean }) {
  return (
    <>
      <ShowMenu />
      {mayOperate && <HandleMenu />}
    </>
  )
}
